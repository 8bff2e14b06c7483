//! The plant of a scenario, and what happens to it.

use crate::plant::{
    BoucWenPlant, BoucWenPlantOptions, LatentWirePlant, LatentWirePlantOptions, PreisachPlant,
    PreisachPlantOptions, SensorOptions, SpringPlant, SpringPlantOptions, WirePlant,
    WirePlantOptions,
};
use hysteron::control::{Disturbance, SimulatedPlant};
use hysteron::{Quantity, Result};
use serde::Deserialize;

/// Which plant, and its options.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum PlantOptions {
    /// The simulated NiTi spring.
    Spring(SpringPlantOptions),
    /// The simulated cloud of relays.
    Preisach(PreisachPlantOptions),
    /// The simulated wire without a thermometer.
    Wire(WirePlantOptions),
    /// The simulated wire whose transformation binds heat.
    LatentWire(LatentWirePlantOptions),
    /// The simulated piezo stage with Bouc-Wen hysteresis.
    BoucWen(BoucWenPlantOptions),
}

/// Something that happens.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// When, s from the start.
    pub at_s: f64,
    /// The load becomes this, N.
    pub load_n: Option<f64>,
    /// The room's temperature becomes this, °C.
    pub room_degc: Option<f64>,
    /// The pre-deformation becomes this, mm.
    pub predeformation_mm: Option<f64>,
    /// The actuator keeps this share of its first stroke.
    pub gain: Option<f64>,
    /// The output's sensor stands still (`true`) or works again.
    pub stuck: Option<bool>,
    /// The output's sensor reads nothing (`true`) or works again.
    pub lost: Option<bool>,
    /// What to call the window that begins here, also where nothing happens to the plant. It is
    /// taken whole. By default it is named after what happens.
    pub window: Option<String>,
}

/// What happens before which sample, in order, as [`Course`](hysteron::control::Course) has it.
#[must_use]
pub fn course(events: &[Event], interval_s: f64) -> Vec<(usize, Disturbance)> {
    let of = |event: &Event| {
        let at = (event.at_s / interval_s).ceil() as usize;
        event.disturbances().into_iter().map(move |what| (at, what))
    };
    let mut events: Vec<_> = events.iter().flat_map(of).collect();
    events.sort_by_key(|(at, _)| *at);
    events
}

impl PlantOptions {
    /// The plant of a kind, with its defaults.
    #[must_use]
    pub fn named(kind: &str) -> Option<Self> {
        match kind {
            "spring" => Some(Self::Spring(SpringPlantOptions::default())),
            "preisach" => Some(Self::Preisach(PreisachPlantOptions::default())),
            "wire" => Some(Self::Wire(WirePlantOptions::default())),
            "latent-wire" => Some(Self::LatentWire(LatentWirePlantOptions::default())),
            "bouc-wen" => Some(Self::BoucWen(BoucWenPlantOptions::default())),
            _ => None,
        }
    }

    /// The plant with the noise of `seed`.
    ///
    /// # Errors
    /// [`hysteron::Error::Plant`] names the option that does not fit.
    pub fn build(&self, seed: u64) -> Result<Box<dyn SimulatedPlant>> {
        Ok(match self {
            Self::Spring(options) => {
                let options = SpringPlantOptions { seed, ..*options };
                Box::new(SpringPlant::new(&options)?)
            }
            Self::Preisach(options) => {
                let options = PreisachPlantOptions { seed, ..*options };
                Box::new(PreisachPlant::new(&options)?)
            }
            Self::Wire(options) => {
                let options = WirePlantOptions { seed, ..*options };
                Box::new(WirePlant::new(&options)?)
            }
            Self::LatentWire(options) => {
                let options = LatentWirePlantOptions { seed, ..*options };
                Box::new(LatentWirePlant::new(&options)?)
            }
            Self::BoucWen(options) => {
                let options = BoucWenPlantOptions { seed, ..*options };
                Box::new(BoucWenPlant::new(&options)?)
            }
        })
    }

    /// Lowest and highest drive.
    #[must_use]
    pub fn drives(&self) -> (f64, f64) {
        match self {
            Self::Spring(options) => (0.0, options.limit_a),
            Self::Preisach(options) => (0.0, options.limit_v),
            Self::Wire(_) | Self::LatentWire(_) => (0.0, 1.0),
            Self::BoucWen(options) => (0.0, options.limit_v),
        }
    }

    /// Names and units of the drive, the hysteresis' input and the output.
    #[must_use]
    pub fn quantities(&self) -> [Quantity; 3] {
        match self {
            Self::Spring(_) => [
                Quantity::with_unit("current", "A"),
                Quantity::with_unit("temperature", "degC"),
                Quantity::with_unit("displacement", "mm"),
            ],
            Self::Preisach(_) | Self::BoucWen(_) => [
                Quantity::with_unit("voltage", "V"),
                Quantity::with_unit("voltage", "V"),
                Quantity::with_unit("displacement", "um"),
            ],
            Self::Wire(_) | Self::LatentWire(_) => [
                Quantity::named("duty"),
                Quantity::with_unit("temperature", "degC"),
                Quantity::with_unit("displacement", "mm"),
            ],
        }
    }

    /// Whether its sensors are noisy enough to tell a stuck one from one at rest. With noise below
    /// the resolution, a working sensor also gives equal readings for long.
    pub(super) fn noisy(&self) -> bool {
        let noisy = |sensor: &SensorOptions| {
            let deviation = sensor.accuracy / 3.0;
            deviation > 0.0 && deviation >= sensor.resolution
        };
        match self {
            Self::Spring(options) => noisy(&options.lvdt) && noisy(&options.thermocouple),
            Self::Preisach(options) => {
                noisy(&options.output_sensor)
                    && (!options.measure_input || noisy(&options.input_sensor))
            }
            Self::Wire(options) => noisy(&options.sensor),
            Self::LatentWire(options) => noisy(&options.sensor),
            Self::BoucWen(options) => noisy(&options.sensor),
        }
    }

    /// Whether a current heats, so that a loop around the temperature is needed.
    pub(super) fn heats(&self) -> bool {
        matches!(self, Self::Spring(_))
    }

    /// Whether the drive heats and nothing measures the temperature, so that the model needs a
    /// thermal body.
    pub(super) fn has_body(&self) -> bool {
        matches!(self, Self::Wire(_) | Self::LatentWire(_))
    }
}

impl Event {
    /// What happens, in the plant's words.
    #[must_use]
    pub fn disturbances(&self) -> Vec<Disturbance> {
        let numbers = [
            self.load_n.map(Disturbance::Load),
            self.room_degc.map(Disturbance::Room),
            self.predeformation_mm.map(Disturbance::Predeformation),
            self.gain.map(Disturbance::Gain),
            self.stuck.map(Disturbance::Stuck),
            self.lost.map(Disturbance::Lost),
        ];
        numbers.into_iter().flatten().collect()
    }

    /// What happens, in words.
    #[must_use]
    pub fn words(&self) -> String {
        if let Some(window) = &self.window {
            return window.clone();
        }
        let words = self.disturbances().into_iter().map(|what| match what {
            Disturbance::Load(n) => format!("load {n} N"),
            Disturbance::Room(t) => format!("room {t} degC"),
            Disturbance::Predeformation(x) => format!("pre-deformation {x} mm"),
            Disturbance::Gain(share) => format!("gain {share}"),
            Disturbance::Stuck(true) => "sensor stuck".into(),
            Disturbance::Lost(true) => "sensor lost".into(),
            Disturbance::Stuck(false) | Disturbance::Lost(false) => "sensor works again".into(),
        });
        words.collect::<Vec<_>>().join(", ")
    }
}
