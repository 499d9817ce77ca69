//! The counting plugin: compiled, tried, and read. `../plugin/sa1110.c` says
//! what it counts.

use std::ffi::OsString;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use rhogrid::error::Error;

use crate::cycles::{Counts, LOAD_DELAY, MULTIPLY_DELAY, SIGNED_LOAD_DELAY};
use crate::{failure, qemu, workspace};

/// A plugin that QEMU loads.
#[derive(Debug)]
pub struct Plugin {
    library: PathBuf,
    counts: PathBuf,
}

impl Plugin {
    /// Compiles it into a folder, where its counts will go, too, and has QEMU
    /// load it.
    ///
    /// # Errors
    /// When there is no C compiler or this QEMU has no such plugins.
    pub fn build(folder: &Path) -> Result<Self, Error> {
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
        })
    }

    /// QEMU's option that loads it.
    pub fn option(&self) -> OsString {
        let delays = format!(
            ",load_delay={LOAD_DELAY},signed_load_delay={SIGNED_LOAD_DELAY},\
             multiply_delay={MULTIPLY_DELAY}"
        );
        let mut option = qemu::option("", &self.library, ",out=");
        option.push(qemu::option("", &self.counts, &delays));
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

/// The file of a running plugin's counts, a line for each interval.
#[derive(Debug)]
pub struct CountsFile {
    path: PathBuf,
    reader: Option<BufReader<File>>,
}

impl CountsFile {
    /// The counts of the next interval between two readings of the timer,
    /// whose end the machine must have reached.
    ///
    /// # Errors
    /// When there are none, or they disagree with the timer.
    pub fn next(&mut self, timer_instructions: u64) -> Result<Counts, Error> {
        let line = self.line().map_err(|error| {
            failure(
                format!("the plugin's counts cannot be read: {error}"),
                "make room in the temporary folder",
            )
        })?;
        let counts: Counts = serde_json::from_str(&line).map_err(|error| {
            failure(
                format!("the plugin printed an unexpected line: {line:?}: {error}"),
                "the plugin must be of the same commit as the runner",
            )
        })?;
        if counts.instructions != timer_instructions {
            return Err(failure(
                format!(
                    "the plugin counted {} instructions where the timer counted \
                     {timer_instructions}",
                    counts.instructions
                ),
                "this QEMU's plugins differ from version 7.2's; use that one",
            ));
        }
        Ok(counts)
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
                r#"{{"instructions":{},"multiplies":1,"long_multiplies":2,"#,
                r#""load_stalls":3,"multiply_stalls":4,"loads":5,"stores":6,"#,
                r#""multiples":7,"multiple_words":8,"taken_branches":9,"#,
                r#""fetch_misses":10,"load_misses":11,"store_misses":12,"#,
                r#""write_backs":13}}"#,
                "\n"
            ),
            instructions
        )
    }

    #[test]
    fn a_line_for_each_interval() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut file = counts_file(folder.path(), &(line(7) + &line(100)));
        assert_eq!(file.next(7).map(|counts| counts.long_multiplies), Ok(2));
        assert_eq!(file.next(100).map(|counts| counts.write_backs), Ok(13));
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
    fn lines_of_another_plugin_are_errors() {
        let folder = tempfile::tempdir().expect("a folder");
        let more = line(5).replace('}', r#","tlb_misses":1}"#);
        let fewer = line(5).replace(r#","write_backs":13"#, "");
        for other in [&more, &fewer, "INSNS 5\n", "\n"] {
            let error = counts_file(folder.path(), other)
                .next(5)
                .expect_err("not these counts");
            assert!(error.what.contains("unexpected line"), "{error}");
        }
    }

    #[test]
    fn commas_in_paths_are_doubled() {
        let plugin = Plugin {
            library: "/a,b/p.so".into(),
            counts: "/a,b/c".into(),
        };
        let option = plugin.option().into_string().expect("UTF-8");
        assert!(
            option.starts_with("/a,,b/p.so,out=/a,,b/c,load_delay="),
            "{option}"
        );
    }
}
