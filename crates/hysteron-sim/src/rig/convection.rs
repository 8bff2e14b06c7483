//! Heat loss of a wire to still air: natural convection around a horizontal cylinder (Churchill &
//! Chu 1975).

/// Air at atmospheric pressure: temperature (K), kinematic viscosity (10⁻⁶ m²/s), thermal
/// conductivity (10⁻³ W/(m·K)), thermal diffusivity (10⁻⁶ m²/s), Prandtl number. Incropera &
/// DeWitt, *Fundamentals of Heat and Mass Transfer*, Table A.4.
const AIR: [[f64; 5]; 5] = [
    [250.0, 11.44, 22.3, 15.9, 0.720],
    [300.0, 15.89, 26.3, 22.5, 0.707],
    [350.0, 20.92, 30.0, 29.9, 0.700],
    [400.0, 26.41, 33.8, 38.3, 0.690],
    [450.0, 32.39, 37.3, 47.2, 0.686],
];

/// 0 °C in kelvin.
const ZERO_CELSIUS: f64 = 273.15;
/// Standard acceleration of free fall, m/s².
const GRAVITY: f64 = 9.806_65;

/// The row of [`AIR`] at `kelvin`, linear between the rows and level beyond the table.
fn air(kelvin: f64) -> [f64; 5] {
    let kelvin = kelvin.clamp(AIR[0][0], AIR[AIR.len() - 1][0]);
    let row = AIR[1..AIR.len() - 1]
        .iter()
        .filter(|row| row[0] <= kelvin)
        .count();
    let (low, high) = (AIR[row], AIR[row + 1]);
    let share = (kelvin - low[0]) / (high[0] - low[0]);
    core::array::from_fn(|n| low[n] + share * (high[n] - low[n]))
}

/// Heat transfer coefficient `h`, W/(m²·K), of a horizontal cylinder of `diameter_m` (m) at
/// `surface_degc` (°C) in still air of `air_degc` (°C).
///
/// `Nu = {0.60 + 0.387 Ra^(1/6) / [1 + (0.559/Pr)^(9/16)]^(8/27)}²` with the properties of air at
/// the mean of both temperatures; valid up to `Ra = 10¹²`. The wire of a spring is nearly
/// horizontal; that neighbouring coils warm each other is left out, and so is radiation.
#[must_use]
pub fn still_air(diameter_m: f64, surface_degc: f64, air_degc: f64) -> f64 {
    let film = 0.5 * (surface_degc + air_degc) + ZERO_CELSIUS;
    let [film_in_table, nu, k, alpha, pr] = air(film);
    let excess = (surface_degc - air_degc).abs();
    // An ideal gas expands by 1/T.
    let rayleigh = GRAVITY / film_in_table * excess * diameter_m.powi(3) / (nu * alpha * 1e-12);
    let prandtl = (1.0 + (0.559 / pr).powf(9.0 / 16.0)).powf(8.0 / 27.0);
    let nusselt = (0.60 + 0.387 * rayleigh.powf(1.0 / 6.0) / prandtl).powi(2);
    nusselt * k * 1e-3 / diameter_m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn air_follows_its_table() {
        assert_eq!(air(300.0), AIR[1]);
        assert_eq!(air(100.0), AIR[0]);
        assert_eq!(air(900.0), AIR[4]);
        let [kelvin, nu, ..] = air(325.0);
        assert!((kelvin - 325.0).abs() < 1e-12 && (nu - 18.405).abs() < 1e-12);
    }

    #[test]
    fn without_excess_only_conduction_is_left() {
        let h = still_air(1e-3, 26.85, 26.85);
        assert!((h - 0.36 * 26.3e-3 / 1e-3).abs() < 1e-9);
    }
}
