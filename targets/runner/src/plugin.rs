//! The counting plugin: compiled, tried, and read. `../plugin/sa1110.c` says
//! what it counts.

use std::ffi::OsString;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use rhogrid::error::Error;
use serde::Deserialize;

use crate::cycles::{Counts, LOAD_DELAY, MULTIPLY_DELAY, SIGNED_LOAD_DELAY};
use crate::stages::{Stage, StageInstructions};
use crate::symbols::Entry;
use crate::{failure, qemu, workspace};

/// A plugin that QEMU loads.
#[derive(Debug)]
pub struct Plugin {
    library: PathBuf,
    counts: PathBuf,
    entries: Vec<Entry>,
}

impl Plugin {
    /// Compiles it into a folder, where its counts will go, too, and has QEMU
    /// load it. It tells apart the stages that begin at `entries`.
    ///
    /// # Errors
    /// When there is no C compiler or this QEMU has no such plugins.
    pub fn build(folder: &Path, entries: Vec<Entry>) -> Result<Self, Error> {
        let source = workspace().join("plugin/sa1110.c");
        let library = folder.join("sa1110.so");
        let output = Command::new("cc")
            .args(["-O2", "-shared", "-fPIC", "-o"])
            .args([&library, &source])
            .stdin(Stdio::null())
            .output()
            .map_err(|error| failure(format!("cannot run cc: {error}"), "install gcc"))?;
        if !output.status.success() {
            let complaint = String::from_utf8_lossy(&output.stderr);
            return Err(failure(
                format!("cc does not compile the plugin: {}", complaint.trim()),
                "install gcc and libc6-dev",
            ));
        }
        qemu::check_plugin(&qemu::option("", &library, ",probe=on"))?;
        Ok(Self {
            library,
            counts: folder.join("counts"),
            entries,
        })
    }

    /// QEMU's option that loads it.
    pub fn option(&self) -> OsString {
        let mut arguments = format!(
            ",load_delay={LOAD_DELAY},signed_load_delay={SIGNED_LOAD_DELAY},\
             multiply_delay={MULTIPLY_DELAY}"
        );
        for Entry { stage, address } in &self.entries {
            arguments += &format!(",entry={}@{address:#x}", *stage as usize);
        }
        let mut option = qemu::option("", &self.library, ",out=");
        option.push(qemu::option("", &self.counts, &arguments));
        option
    }

    /// What it counts; QEMU need not have started.
    pub fn counts_file(&self) -> CountsFile {
        CountsFile {
            path: self.counts.clone(),
            reader: None,
        }
    }
}

/// What the plugin says of an interval between two readings of the timer.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    /// What it counted.
    pub counts: Counts,
    /// Instructions by number of the stage, as far as stages are told apart.
    stage_instructions: Vec<u64>,
    /// The stage that did not return; zero if all did.
    unfinished_stage: usize,
}

impl Interval {
    /// Instructions of every stage, without the `outside` that are no part of
    /// any.
    ///
    /// # Errors
    /// When stages were not told apart, or do not add up to the interval.
    pub fn stages(&self, outside: u64) -> Result<StageInstructions, Error> {
        if let Some(stage) = Stage::ALL
            .get(self.unfinished_stage)
            .filter(|&&stage| stage != Stage::SetUp)
        {
            return Err(failure(
                format!(
                    "the stage `{}` did not return where it was called",
                    stage.name()
                ),
                "the compiler calls its function in another way; give it a caller that does not end with it",
            ));
        }
        let all: Result<[u64; Stage::ALL.len()], _> = self.stage_instructions.as_slice().try_into();
        let stages = all.ok().and_then(|mut all| {
            all[Stage::SetUp as usize] = all[Stage::SetUp as usize].checked_sub(outside)?;
            Some(StageInstructions(all))
        });
        stages
            .filter(|stages| stages.sum() + outside == self.counts.instructions)
            .ok_or_else(|| {
                failure(
                    format!(
                        "the stages' instructions {:?} do not add up to {}",
                        self.stage_instructions, self.counts.instructions
                    ),
                    "this QEMU's plugins differ from version 7.2's; use that one",
                )
            })
    }
}

/// The file of a running plugin's counts, a line for each interval.
#[derive(Debug)]
pub struct CountsFile {
    path: PathBuf,
    reader: Option<BufReader<File>>,
}

impl CountsFile {
    /// The next interval between two readings of the timer, whose end the
    /// machine must have reached.
    ///
    /// # Errors
    /// When there are none, or they disagree with the timer.
    pub fn next(&mut self, timer_instructions: u64) -> Result<Interval, Error> {
        let line = self.line().map_err(|error| {
            failure(
                format!("the plugin's counts cannot be read: {error}"),
                "make room in the temporary folder",
            )
        })?;
        let interval: Interval = serde_json::from_str(&line).map_err(|error| {
            failure(
                format!("the plugin printed an unexpected line: {line:?}: {error}"),
                "the plugin must be of the same commit as the runner",
            )
        })?;
        let counted = interval.counts.instructions;
        if counted != timer_instructions {
            return Err(failure(
                format!(
                    "the plugin counted {counted} instructions where the timer counted \
                     {timer_instructions}"
                ),
                "this QEMU's plugins differ from version 7.2's; use that one",
            ));
        }
        Ok(interval)
    }

    fn line(&mut self) -> std::io::Result<String> {
        let reader = match &mut self.reader {
            Some(reader) => reader,
            none => none.insert(BufReader::new(File::open(&self.path)?)),
        };
        let mut line = String::new();
        if reader.read_line(&mut line)? == 0 {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        Ok(line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The file of a plugin that printed these lines.
    fn counts_file(folder: &Path, lines: &str) -> CountsFile {
        let path = folder.join("counts");
        std::fs::write(&path, lines).expect("writes");
        CountsFile { path, reader: None }
    }

    fn line(instructions: u64) -> String {
        format!(
            concat!(
                r#"{{"counts":{{"instructions":{},"multiplies":1,"long_multiplies":2,"#,
                r#""load_stalls":3,"multiply_stalls":4,"loads":5,"stores":6,"#,
                r#""multiples":7,"multiple_words":8,"taken_branches":9,"#,
                r#""fetch_misses":10,"load_misses":11,"store_misses":12,"#,
                r#""write_backs":13}},"stage_instructions":[1,2,3,4,5],"#,
                r#""unfinished_stage":0}}"#,
                "\n"
            ),
            instructions
        )
    }

    #[test]
    fn a_line_for_each_interval() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut file = counts_file(folder.path(), &(line(7) + &line(100)));
        assert_eq!(
            file.next(7).map(|interval| interval.counts.long_multiplies),
            Ok(2)
        );
        assert_eq!(
            file.next(100).map(|interval| interval.counts.write_backs),
            Ok(13)
        );
        let error = file.next(1).expect_err("the end");
        assert!(error.what.contains("cannot be read"), "{error}");
    }

    #[test]
    fn a_count_that_is_not_the_timers_is_an_error() {
        let folder = tempfile::tempdir().expect("a folder");
        let error = counts_file(folder.path(), &line(100))
            .next(101)
            .expect_err("one too few");
        let what = "the plugin counted 100 instructions where the timer counted 101";
        assert_eq!(error.what, what);
    }

    #[test]
    fn stages_add_up_to_the_interval() {
        let interval = |instructions, stages: &str| {
            let line = line(instructions).replace("[1,2,3,4,5]", stages);
            serde_json::from_str::<Interval>(&line).expect("an interval")
        };
        let stages = interval(25, "[11,2,3,4,5]").stages(10);
        assert_eq!(stages, Ok(StageInstructions([1, 2, 3, 4, 5])));
        for (instructions, stages) in [
            (24, "[11,2,3,4,5]"),
            (23, "[9,2,3,4,5]"),
            (25, "[25]"),
            (25, "[10,2,3,4,5,1]"),
        ] {
            let error = interval(instructions, stages).stages(10).expect_err(stages);
            assert!(error.what.contains("do not add up"), "{error}");
        }
        let mut interval = interval(15, "[1,2,3,4,5]");
        interval.unfinished_stage = Stage::Traversal as usize;
        let error = interval.stages(0).expect_err("it did not return");
        assert!(error.what.contains("`traversal` did not return"), "{error}");
    }

    #[test]
    fn lines_of_another_plugin_are_errors() {
        let folder = tempfile::tempdir().expect("a folder");
        let more = line(5).replace(r#":13}"#, r#":13,"tlb_misses":1}"#);
        let fewer = line(5).replace(r#","write_backs":13"#, "");
        for other in [&more, &fewer, "INSNS 5\n", "\n"] {
            let error = counts_file(folder.path(), other)
                .next(5)
                .expect_err("not these counts");
            assert!(error.what.contains("unexpected line"), "{error}");
        }
    }

    #[test]
    fn options_are_qemus() {
        let plugin = Plugin {
            library: "/a,b/p.so".into(),
            counts: "/a,b/c".into(),
            entries: vec![Entry {
                stage: Stage::Clear,
                address: 0x1a2b8,
            }],
        };
        let option = plugin.option().into_string().expect("UTF-8");
        assert!(
            option.starts_with("/a,,b/p.so,out=/a,,b/c,load_delay="),
            "{option}"
        );
        assert!(option.ends_with(",entry=2@0x1a2b8"), "{option}");
    }
}
