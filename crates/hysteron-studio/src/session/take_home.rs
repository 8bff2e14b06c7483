//! What can be taken home: the model, code, a report, the numbers of a picture, the same work as
//! commands, the session.

use super::c_archive;
use super::commands;
use super::fault::Fault;
use super::id::Id;
use super::judged::doubts_in;
use super::state::Session;
use super::thinned::rows;
use super::view::View;
use super::wish::Wish;
use base64::Engine;
use hysteron::{TableWriter, Verdict, evaluate};
use hysteron_export::{COptions, CReal, CSampling, FmuOptions};
use hysteron_report::{Made, Report, Shown};
use serde::{Deserialize, Serialize, Serializer};
use std::io::{Cursor, Write};
use std::path::Path;

/// What is to be taken home.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "what", rename_all = "snake_case")]
pub enum Take {
    /// The model file.
    Model {
        /// The fit.
        fit: Id,
    },
    /// C99 for a microcontroller, as an archive with a program that shows its use.
    C {
        /// The fit.
        fit: Id,
    },
    /// A block for Simulink and other tools.
    Fmu {
        /// The fit.
        fit: Id,
        /// The inverse instead of the model.
        #[serde(default)]
        inverse: bool,
    },
    /// The report of a fit on a file, one page.
    Report {
        /// The fit.
        fit: Id,
        /// The file.
        file: Id,
    },
    /// The numbers of a picture, as a table.
    Csv(View),
    /// All samples of the part that is shown, with the outputs and residuals of the fits, as CSV.
    Table(View),
    /// The same as Parquet.
    Parquet(View),
    /// The profile of an experiment, as CSV.
    Profile(Wish),
    /// What came of the last path of a drive, as CSV.
    Way {
        /// The drive.
        drive: Id,
    },
    /// The commands that do what was clicked.
    Command {
        /// The fit.
        fit: Id,
    },
    /// The same in Python.
    Python {
        /// The fit.
        fit: Id,
    },
    /// The same in Rust.
    Rust {
        /// The fit.
        fit: Id,
    },
    /// The session, which opens again. It holds the recordings.
    Session,
}

/// A file for the user.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Download {
    /// Its name.
    pub name: String,
    /// Its media type.
    pub media: &'static str,
    /// Its bytes; in JSON as base64.
    #[serde(serialize_with = "base64")]
    pub bytes: Vec<u8>,
}

fn base64<S: Serializer>(bytes: &[u8], to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(&base64::engine::general_purpose::STANDARD.encode(bytes))
}

impl Session {
    pub(super) fn take(&mut self, take: &Take) -> Result<Download, Fault> {
        let found = self.taken(take)?;
        // It goes to the page as text.
        match self.memory.has(3 * found.bytes.len() as u64) {
            true => Ok(found),
            false => Err(Fault::too_large(&found.name, self.room())),
        }
    }

    fn taken(&mut self, take: &Take) -> Result<Download, Fault> {
        let text = |name: &str, media, text: String| Download {
            name: name.into(),
            media,
            bytes: text.into_bytes(),
        };
        Ok(match *take {
            Take::Model { fit } => {
                let model = &self.fitted(fit)?.model;
                text("model.json", "application/json", model.to_json())
            }
            Take::C { fit } => self.c(fit)?,
            Take::Fmu { fit, inverse } => self.fmu(fit, inverse)?,
            Take::Report { fit, file } => self.report(fit, file)?,
            Take::Csv(ref view) => text("picture.csv", "text/csv", self.csv(view)?),
            Take::Table(ref view) => Download {
                name: "samples.csv".into(),
                media: "text/csv",
                bytes: self.table(view, "samples.csv")?,
            },
            Take::Parquet(ref view) => Download {
                name: "samples.parquet".into(),
                media: "application/vnd.apache.parquet",
                bytes: self.table(view, "samples.parquet")?,
            },
            Take::Profile(ref wish) => Download {
                name: "profile.csv".into(),
                media: "text/csv",
                bytes: self.profile_table(wish)?,
            },
            Take::Way { drive } => Download {
                name: "way.csv".into(),
                media: "text/csv",
                bytes: self.followed_table(drive)?,
            },
            Take::Command { fit } => text(
                "fit.sh",
                "text/plain",
                commands::shell(self, self.fitted_to_open(fit)?),
            ),
            Take::Python { fit } => text(
                "fit.py",
                "text/plain",
                commands::python(self, self.fitted_to_open(fit)?),
            ),
            Take::Rust { fit } => text(
                "fit.rs",
                "text/plain",
                commands::rust(self, self.fitted_to_open(fit)?),
            ),
            Take::Session => Download {
                name: "studio.session.json".into(),
                media: "application/json",
                bytes: self.session_file()?,
            },
        })
    }

    fn session_file(&self) -> Result<Vec<u8>, Fault> {
        let mut file = self.upload();
        let written = self.write_to(&mut file);
        written.map_err(|_| Fault::too_large("the session", self.room()))?;
        Ok(file.into_bytes())
    }

    fn c(&self, fit: Id) -> Result<Download, Fault> {
        let fitted = self.fitted(fit)?;
        let options = COptions {
            real: CReal::Float,
            name: Some("model"),
            source: Path::new("model.json"),
            adaptation: false,
        };
        let sampling = CSampling {
            dt: fitted.dt.filter(|_| fitted.model.is_timed()),
            drive: None,
            ..CSampling::default()
        };
        let (made, texts) = hysteron_export::c_texts(&fitted.model, &options, &sampling)?;
        let mut files: Vec<(String, String)> = made
            .files
            .iter()
            .map(|file| file.display().to_string())
            .zip(texts)
            .collect();
        files.extend(c_archive::beside(&fitted.model, &made, &files));
        let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (file, text) in files {
            let stored = zip::write::SimpleFileOptions::default();
            zip.start_file(format!("model-c/{file}"), stored)
                .and_then(|()| Ok(zip.write_all(text.as_bytes())?))
                .map_err(|error| Fault::defect(&error.to_string()))?;
        }
        let zip = zip
            .finish()
            .map_err(|error| Fault::defect(&error.to_string()))?;
        Ok(Download {
            name: "model-c.zip".into(),
            media: "application/zip",
            bytes: zip.into_inner(),
        })
    }

    fn fmu(&self, fit: Id, inverse: bool) -> Result<Download, Fault> {
        let model = &self.fitted(fit)?.model;
        let name = if inverse { "inverse.fmu" } else { "model.fmu" };
        let options = FmuOptions {
            inverse,
            ..FmuOptions::default()
        };
        Ok(Download {
            name: name.into(),
            media: "application/octet-stream",
            bytes: hysteron_export::fmu_bytes(model, &options)?.1,
        })
    }

    fn report(&self, fit: Id, file: Id) -> Result<Download, Fault> {
        let model = &self.fitted(fit)?.model;
        let opened = self.file(file)?;
        let recordings = opened.parts()?.all();
        let evaluation = evaluate(model, recordings)?;
        let verdict = Verdict::of_evaluation(model, recordings, &evaluation)?;
        let verdict = verdict.doubting(doubts_in(recordings)?.len());
        let title = format!("fit {fit} on {}", opened.name);
        let report = Report {
            title: &title,
            shown: Shown::Evaluation {
                model,
                recordings,
                evaluation: &evaluation,
                verdict: Some(&verdict),
            },
            made: Made::default(),
        };
        let page = report.page();
        let page = page.map_err(|error| Fault::defect(&error.to_string()))?;
        Ok(Download {
            name: "report.html".into(),
            media: "text/html",
            bytes: page.into_bytes(),
        })
    }

    /// The samples of a view.
    fn table(&mut self, view: &View, name: &str) -> Result<Vec<u8>, Fault> {
        let recording = self.file(view.file)?.recording()?.clone();
        let mut courses = Vec::new();
        for &fit in &view.fits {
            courses.push((fit, self.course(fit, view.file)?));
        }
        let mut names: Vec<String> = recording.time.iter().map(|_| "time [s]".into()).collect();
        names.push(recording.input_quantity.to_column());
        names.push(recording.output_quantity.to_column());
        names.extend(
            recording
                .load
                .iter()
                .map(|_| recording.load_quantity.to_column()),
        );
        for (fit, _) in &courses {
            names.extend([
                format!("model of fit {fit}"),
                format!("residual of fit {fit}"),
            ]);
        }
        let rows = rows(&recording, view.window);
        let rows = rows.filter(|n| view.area.has(&recording, *n));
        let mut table = TableWriter::in_memory(name, &self.memory)?;
        table.row(&names)?;
        for n in rows {
            let mut cells: Vec<f64> = recording.time.iter().map(|time| time[n]).collect();
            cells.extend([recording.input[n], recording.output[n]]);
            cells.extend(recording.load.iter().map(|load| load[n]));
            for (_, course) in &courses {
                cells.extend([course[n], recording.output[n] - course[n]]);
            }
            table.row(cells.iter().map(f64::to_string))?;
        }
        Ok(table.into_bytes()?)
    }

    fn csv(&mut self, view: &View) -> Result<String, Fault> {
        let curves = self.curves(view)?;
        let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
        let mut text = format!("line,{},{}\n", quoted(&curves.x), quoted(&curves.y));
        for line in &curves.lines {
            let name = line
                .fit
                .map_or("measured".into(), |fit| format!("fit {fit}"));
            for (x, y) in line.x.iter().zip(&line.y) {
                if let (Some(x), Some(y)) = (x, y) {
                    text += &format!("{name},{x},{y}\n");
                }
            }
        }
        Ok(text)
    }
}
