//! Counted cases as Markdown. Figures are means over the views of a name:
//! `full` is `full/0`, `full/90` and so on.

use std::fmt::Write;

use rhogrid_targets::stages::{Stage, StageInstructions};

use crate::measure::{Counted, Frame};

/// What all figures of a run have in common.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Names of host and machine, as columns.
    pub machines: [String; 2],
    /// Compiler and tools.
    pub tools: String,
}

/// Means over the views of one name.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Mean {
    samples_drawn: f64,
    pixels_shown: f64,
    stages: [f64; Stage::ALL.len()],
}

impl Mean {
    fn of(frames: &[&Frame], stages: fn(&Frame) -> StageInstructions) -> Self {
        let count = frames.len().max(1) as f64;
        let mean = |value: &dyn Fn(&Frame) -> u64| {
            frames.iter().map(|frame| value(frame) as f64).sum::<f64>() / count
        };
        Self {
            samples_drawn: mean(&|frame| frame.samples_drawn),
            pixels_shown: mean(&|frame| frame.pixels_shown),
            stages: Stage::ALL.map(|stage| mean(&|frame| stages(frame)[stage])),
        }
    }

    fn whole(&self) -> f64 {
        self.stages.iter().sum()
    }
}

/// Instructions of host and machine, in the order of [`Setting::machines`].
const COLUMNS: [fn(&Frame) -> StageInstructions; 2] = [|frame| frame.host, |frame| frame.machine];

/// The tables: whole frames, then stages and rates for each machine.
pub fn markdown(setting: &Setting, cases: &[Counted]) -> String {
    let mut text = whole_frames(setting, cases);
    for (machine, stages) in setting.machines.iter().zip(COLUMNS).rev() {
        text.push('\n');
        text += &by_stage(machine, cases, stages);
    }
    let _ = writeln!(
        text,
        "\nThe last three columns are instructions, of the whole frame, for each sample\n\
         that reached the depth test, each pixel that shows something, and each leaf\n\
         sample of the asset. `benches/run` made these tables ({}).",
        setting.tools
    );
    text
}

fn whole_frames(setting: &Setting, cases: &[Counted]) -> String {
    let names = cases.first().map_or_else(Vec::new, view_names);
    let mut heading = "| instructions a frame, millions |".to_owned();
    for machine in &setting.machines {
        for (index, name) in names.iter().enumerate() {
            let machine = if index == 0 { machine.as_str() } else { "" };
            let separator = if index == 0 { ", " } else { "" };
            let _ = write!(heading, " {machine}{separator}{name} |");
        }
    }
    let mut text = with_rule(&heading);
    for counted in cases {
        let _ = write!(text, "| {} |", counted.case.name);
        for stages in COLUMNS {
            for name in &names {
                let mean = Mean::of(&frames_of(counted, name), stages);
                let _ = write!(text, " {:.2} |", mean.whole() / 1e6);
            }
        }
        text.push('\n');
    }
    text
}

fn by_stage(machine: &str, cases: &[Counted], stages: fn(&Frame) -> StageInstructions) -> String {
    let names: Vec<&str> = Stage::ALL.iter().map(|stage| stage.name()).collect();
    let mut text = with_rule(&format!(
        "| {machine}, thousands | {} | whole | a sample | a pixel | a leaf |",
        names.join(" | ")
    ));
    for counted in cases {
        for view in view_names(counted) {
            let mean = Mean::of(&frames_of(counted, view), stages);
            let _ = write!(text, "| {}, {view} |", counted.case.name);
            for thousands in mean.stages.iter().chain([&mean.whole()]) {
                let _ = write!(text, " {:.1} |", thousands / 1e3);
            }
            let divisors = [mean.samples_drawn, mean.pixels_shown];
            for divisor in divisors.into_iter().chain([counted.leaf_samples as f64]) {
                let _ = write!(text, " {} |", rate(mean.whole(), divisor));
            }
            text.push('\n');
        }
    }
    text
}

fn rate(instructions: f64, divisor: f64) -> String {
    if divisor == 0.0 {
        return "-".to_owned();
    }
    format!("{:.1}", instructions / divisor)
}

/// A heading and the line that Markdown wants below it.
fn with_rule(heading: &str) -> String {
    let columns = heading.matches('|').count() - 1;
    format!("{heading}\n|{}\n", "---|".repeat(columns))
}

/// Names of a case's views without their yaws, each once.
fn view_names(counted: &Counted) -> Vec<&str> {
    let mut names: Vec<&str> = counted.frames.iter().map(view_name).collect();
    names.dedup();
    names
}

fn view_name(frame: &Frame) -> &str {
    frame.view.split('/').next().unwrap_or(&frame.view)
}

fn frames_of<'a>(counted: &'a Counted, name: &str) -> Vec<&'a Frame> {
    let frames = counted.frames.iter();
    frames.filter(|frame| view_name(frame) == name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::CASES;

    fn frame(view: &str, samples_drawn: u64, scale: u64) -> Frame {
        Frame {
            view: view.to_owned(),
            frame_hash: 0,
            samples_drawn,
            pixels_shown: 5_000,
            host: StageInstructions([scale; 5]),
            machine: StageInstructions([10, 20, 30, 40, 50].map(|part| part * scale)),
        }
    }

    #[test]
    fn figures_are_means_over_yaws() {
        let counted = Counted {
            case: &CASES[0],
            leaf_samples: 100_000,
            frames: vec![
                frame("full/0", 10_000, 10_000),
                frame("full/90", 30_000, 30_000),
                frame("far/0", 0, 1_000),
            ],
        };
        let setting = Setting {
            machines: ["host", "device"].map(str::to_owned),
            tools: "tools".to_owned(),
        };
        let text = markdown(&setting, &[counted]);
        let expected = "\
| instructions a frame, millions | host, full | far | device, full | far |
|---|---|---|---|---|
| demo, level 4 | 0.10 | 0.01 | 3.00 | 0.15 |

| device, thousands | set-up | shade table | clear | traversal | resolve | whole | a sample | a pixel | a leaf |
|---|---|---|---|---|---|---|---|---|---|
| demo, level 4, full | 200.0 | 400.0 | 600.0 | 800.0 | 1000.0 | 3000.0 | 150.0 | 600.0 | 30.0 |
| demo, level 4, far | 10.0 | 20.0 | 30.0 | 40.0 | 50.0 | 150.0 | - | 30.0 | 1.5 |

| host, thousands | set-up | shade table | clear | traversal | resolve | whole | a sample | a pixel | a leaf |
|---|---|---|---|---|---|---|---|---|---|
| demo, level 4, full | 20.0 | 20.0 | 20.0 | 20.0 | 20.0 | 100.0 | 5.0 | 20.0 | 1.0 |
| demo, level 4, far | 1.0 | 1.0 | 1.0 | 1.0 | 1.0 | 5.0 | - | 1.0 | 0.1 |
";
        assert!(text.starts_with(expected), "{text}");
        assert!(text.ends_with("these tables (tools).\n"), "{text}");
    }

    #[test]
    fn nothing_counted_is_no_panic() {
        let setting = Setting {
            machines: ["host", "device"].map(str::to_owned),
            tools: String::new(),
        };
        assert!(markdown(&setting, &[]).starts_with("| instructions a frame, millions |\n|---|\n"));
    }
}
