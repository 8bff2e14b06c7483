//! The sources in an FMU: the model as exported C, and a thin layer of the standard over it, for
//! platforms that no binary is for.

use super::options::{Block, Fmi};
use super::staged::{first, first_target, is_loaded};
use crate::c::{COptions, CReal, CSampling, LICENCE, c_texts};
use hysteron::{Model, Result};
use std::path::Path;

/// The name of the model in the C.
const NAME: &str = "block_model";

const BLOCK: [(&str, &str); 3] = [
    (
        "hysteron_block.h",
        include_str!("../../fmi/hysteron_block.h"),
    ),
    (
        "hysteron_block.c",
        include_str!("../../fmi/hysteron_block.c"),
    ),
    (
        "hysteron_states.h",
        include_str!("../../fmi/hysteron_states.h"),
    ),
];

/// Files of the sources, in FMI 3.0 with their description.
pub(super) const COUNTS: [usize; 2] = [11, 12];

/// Names and texts, but for those that name the token.
pub(super) struct Sources {
    fmi: Fmi,
    files: Vec<(String, String)>,
    /// The head of the block without its token.
    head: String,
}

impl Sources {
    /// `None` for a controller, and for a model that has more than operators: the sample time of its
    /// exported C is fixed, and a communication step may have any length.
    pub(super) fn new(model: &Model, block: Block<'_>, fmi: Fmi) -> Result<Option<Self>> {
        let first = match block {
            Block::Forward => first(model).0,
            Block::Inverse => first_target(model)?,
            Block::Controller(_) => return Ok(None),
        };
        let bare = model.constants().is_none() && model.delay().is_none();
        if !bare || is_loaded(model) {
            return Ok(None);
        }
        let options = COptions {
            real: CReal::Double,
            name: Some(NAME),
            source: Path::new("model.json"),
            adaptation: false,
        };
        // A model whose numbers are too small for C has its binaries.
        let Ok((export, texts)) = c_texts(model, &options, &CSampling::default()) else {
            return Ok(None);
        };
        let names = export.files.iter().map(|file| file.display().to_string());
        let layer = match fmi {
            Fmi::V2 => ("hysteron_fmi2.c", include_str!("../../fmi/hysteron_fmi2.c")),
            Fmi::V3 => ("hysteron_fmi3.c", include_str!("../../fmi/hysteron_fmi3.c")),
        };
        let version = env!("CARGO_PKG_VERSION");
        let ours = BLOCK.into_iter().chain([layer]).map(|(name, text)| {
            let text = format!("/* hysteron {version}.\n * {LICENCE} */\n{text}");
            (name.into(), text)
        });
        let start = match model.fitted() {
            None => "",
            Some(_) => {
                "#define BLOCK_START block_model_start\n\
                 #define BLOCK_START_INPUT block_model_start_input\n"
            }
        };
        let head = format!(
            "#include \"{NAME}.h\"\n\n\
             #define BLOCK_MODEL {NAME}\n\
             #define BLOCK_LEVELS BLOCK_MODEL_LEVELS\n\
             #define BLOCK_TURNS BLOCK_MODEL_TURNS\n\
             #define BLOCK_INVERSE {}\n\
             #define BLOCK_FIRST {first:?}\n{start}",
            u8::from(!block.is_forward()),
        );
        Ok(Some(Self {
            fmi,
            files: names.zip(texts).chain(ours).collect(),
            head,
        }))
    }

    /// The files that are compiled.
    pub(super) fn compiled(&self) -> impl Iterator<Item = &str> {
        let names = self.files.iter().map(|(name, _)| name.as_str());
        names.filter(|name| name.ends_with(".c"))
    }

    /// Names and texts of all files, for the block `name` with its token.
    pub(super) fn files(self, name: &str, token: &str) -> Vec<(String, String)> {
        let described = (self.fmi == Fmi::V3).then(|| self.described(name));
        let head = format!("{}#define BLOCK_TOKEN \"{token}\"\n", self.head);
        let mut files = self.files;
        files.push(("block.h".into(), head));
        files.extend(described.map(|text| ("buildDescription.xml".into(), text)));
        files
    }

    /// What FMI 3.0 asks for beside them.
    fn described(&self, name: &str) -> String {
        let files = self.compiled();
        let files: String = files
            .map(|file| format!("      <SourceFile name=\"{file}\"/>\n"))
            .collect();
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <fmiBuildDescription fmiVersion=\"3.0\">\n  \
             <BuildConfiguration modelIdentifier=\"{name}\">\n    \
             <SourceFileSet language=\"C99\">\n{files}    \
             </SourceFileSet>\n  \
             </BuildConfiguration>\n\
             </fmiBuildDescription>\n"
        )
    }
}
