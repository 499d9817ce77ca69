//! What is drawn and counted: a line for each case.

use clap::Parser;
use rhogrid::cli::{Failure, QualityArgs, SourceArgs};
use rhogrid::error::Error;
use rhogrid_targets::failure;

/// An asset and how it is drawn.
#[derive(Debug)]
pub struct Case {
    /// What tables call it.
    pub name: &'static str,
    /// The built-in scene, or a file of the folder of models.
    pub input: &'static str,
    /// Options of `rhogrid bake`.
    pub baking: &'static str,
    /// Options of `rhogrid render`.
    pub drawing: &'static str,
}

/// All of them, in the order of the tables.
#[rustfmt::skip]
pub static CASES: &[Case] = &[
    Case { name: "demo, level 4", input: "builtin:demo", baking: "--level 4", drawing: "" },
    Case { name: "bunny, level 5", input: "bunny.ply", baking: "--level 5", drawing: "" },
    Case { name: "buddha, level 5", input: "buddha_100k.ply", baking: "--level 5 --up z", drawing: "" },
    Case { name: "buddha, level 4, every leaf a point", input: "buddha_100k.ply", baking: "--level 4 --up z", drawing: "--culling off --splat 0" },
];

/// What a test of this program can wait for.
pub static QUICK: Case = Case {
    name: "demo, level 3",
    input: "builtin:demo",
    baking: "--level 3",
    drawing: "",
};

#[derive(Parser)]
struct Options {
    #[command(flatten)]
    source: SourceArgs,
    #[command(flatten)]
    quality: QualityArgs,
}

impl Case {
    /// Whether the input is no file.
    pub fn is_built_in(&self) -> bool {
        self.input.starts_with("builtin:")
    }

    /// Its options, as the command line has them.
    ///
    /// # Errors
    /// When the command line refuses them.
    pub fn options(&self) -> Result<(SourceArgs, QualityArgs), Error> {
        let refused = |what: String| {
            failure(
                format!("the case `{}` has bad options: {what}", self.name),
                "correct it in benches/src/cases.rs",
            )
        };
        let texts = [self.baking, self.drawing];
        let words = texts.iter().flat_map(|text| text.split_whitespace());
        let options = Options::try_parse_from(std::iter::once("").chain(words))
            .map_err(|error| refused(error.to_string()))?;
        let Options { source, quality } = options;
        match source.check().and_then(|()| quality.check()) {
            Ok(()) => Ok((source, quality)),
            Err(Failure::Usage(what)) => Err(refused(what)),
            Err(Failure::Failed(error)) => Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_cases_have_good_options_and_names_of_their_own() {
        for case in CASES.iter().chain([&QUICK]) {
            assert!(case.options().is_ok(), "{case:?}");
            let namesakes = CASES.iter().filter(|other| other.name == case.name);
            assert!(namesakes.count() <= 1, "{case:?}");
        }
        let (source, _) = CASES[2].options().expect("good");
        assert_eq!(source.grid_options().level, 5);
    }

    #[test]
    fn bad_options_are_said() {
        for (baking, drawing) in [("--level 99", ""), ("", "--splat -1"), ("--lever 4", "")] {
            let case = Case {
                baking,
                drawing,
                ..QUICK
            };
            let error = case.options().expect_err("bad");
            assert!(error.what.contains("`demo, level 3`"), "{error}");
        }
    }
}
