//! Counted cases as one JSON object, view by view.

use std::collections::BTreeMap;

use rhogrid_targets::stages::{Stage, StageInstructions};
use serde::{Serialize, Serializer};

use crate::measure::{Counted, Frame};
use crate::table::Setting;

/// A run.
#[derive(Serialize)]
pub struct Run<'a> {
    tools: &'a str,
    cases: Vec<Case<'a>>,
}

#[derive(Serialize)]
struct Case<'a> {
    case: &'a str,
    input: &'a str,
    baking: &'a str,
    drawing: &'a str,
    leaf_samples: u64,
    frames: Vec<View<'a>>,
}

#[derive(Serialize)]
struct View<'a> {
    view: &'a str,
    #[serde(serialize_with = "hex")]
    frame_hash: u32,
    samples_drawn: u64,
    pixels_shown: u64,
    instructions: BTreeMap<&'a str, Instructions>,
}

#[derive(Serialize)]
struct Instructions {
    whole: u64,
    stages: BTreeMap<&'static str, u64>,
}

fn hex<S: Serializer>(hash: &u32, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&format_args!("{hash:08x}"))
}

impl<'a> Run<'a> {
    /// What there is to say of it.
    pub fn new(setting: &'a Setting, cases: &'a [Counted]) -> Self {
        let case = |counted: &'a Counted| Case {
            case: counted.case.name,
            input: counted.case.input,
            baking: counted.case.baking,
            drawing: counted.case.drawing,
            leaf_samples: counted.leaf_samples,
            frames: counted
                .frames
                .iter()
                .map(|frame| view(setting, frame))
                .collect(),
        };
        Self {
            tools: &setting.tools,
            cases: cases.iter().map(case).collect(),
        }
    }
}

fn view<'a>(setting: &'a Setting, frame: &'a Frame) -> View<'a> {
    let machines = setting.machines.iter().zip([frame.host, frame.machine]);
    View {
        view: &frame.view,
        frame_hash: frame.frame_hash,
        samples_drawn: frame.samples_drawn,
        pixels_shown: frame.pixels_shown,
        instructions: machines
            .map(|(machine, stages)| (machine.as_str(), instructions(stages)))
            .collect(),
    }
}

fn instructions(stages: StageInstructions) -> Instructions {
    let named = Stage::ALL.map(|stage| (key(stage), stages[stage]));
    Instructions {
        whole: stages.sum(),
        stages: named.into_iter().collect(),
    }
}

fn key(stage: Stage) -> &'static str {
    match stage {
        Stage::SetUp => "set_up",
        Stage::ShadeTable => "shade_table",
        Stage::Clear => "clear",
        Stage::Traversal => "traversal",
        Stage::Resolve => "resolve",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::QUICK;

    #[test]
    fn keys_are_stable() {
        let frame = Frame {
            view: "full/0".to_owned(),
            frame_hash: 0xabc,
            samples_drawn: 6,
            pixels_shown: 5,
            host: StageInstructions([1, 2, 3, 4, 5]),
            machine: StageInstructions([6, 7, 8, 9, 10]),
        };
        let counted = Counted {
            case: &QUICK,
            leaf_samples: 9,
            frames: vec![frame],
        };
        let setting = Setting {
            machines: ["host", "device"].map(str::to_owned),
            tools: "tools".to_owned(),
        };
        let json = serde_json::to_string(&Run::new(&setting, &[counted])).expect("serialises");
        let expected = concat!(
            r#"{"tools":"tools","cases":[{"case":"demo, level 3","input":"builtin:demo","#,
            r#""baking":"--level 3","drawing":"","leaf_samples":9,"#,
            r#""frames":[{"view":"full/0","frame_hash":"00000abc","samples_drawn":6,"#,
            r#""pixels_shown":5,"instructions":{"device":{"whole":40,"stages":"#,
            r#"{"clear":8,"resolve":10,"set_up":6,"shade_table":7,"traversal":9}},"#,
            r#""host":{"whole":15,"stages":"#,
            r#"{"clear":3,"resolve":5,"set_up":1,"shade_table":2,"traversal":4}}}}]}]}"#
        );
        assert_eq!(json, expected);
    }
}
