//! The command itself: exit codes, messages, JSON keys, files.

mod bake;
mod compare;
mod errors;
mod quality;
mod render;
mod scene;

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// A folder of a test's own, with a cube in it.
struct Folder(tempfile::TempDir);

/// What a run of the command did.
struct Run {
    code: i32,
    stdout: String,
    stderr: String,
}

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        folder.write("cube.obj", CUBE);
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).unwrap();
    }

    fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rhogrid"));
        command
            .args(line.split_whitespace())
            .current_dir(self.0.path());
        command
    }

    /// Runs the command with these words, in this folder.
    fn run(&self, line: &str) -> Run {
        let output = self.command(line).output().unwrap();
        Run {
            code: output.status.code().expect("no signal"),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Runs and expects success, in silence on stderr.
    #[track_caller]
    fn done(&self, line: &str) -> String {
        let run = self.run(line);
        assert_eq!(run.code, 0, "{line}: {}", run.stderr);
        assert_eq!(run.stderr, "", "{line}");
        run.stdout
    }

    /// Runs with --json and gives the one object.
    #[track_caller]
    fn json(&self, line: &str) -> Value {
        let text = self.done(&format!("{line} --json"));
        assert_eq!(text.lines().count(), 1, "{text}");
        let value: Value = serde_json::from_str(&text).unwrap();
        assert!(value.is_object(), "{text}");
        value
    }
}

#[track_caller]
fn assert_keys(value: &Value, keys: &[&str]) {
    for key in keys {
        assert!(value.get(key).is_some(), "no {key} in {value}");
    }
}

fn png(path: &Path) -> rhogrid::picture::Picture {
    rhogrid::picture::Picture::load(path).unwrap()
}

/// Beside the origin and not a cube, so that centres and axes matter.
const CUBE: &str = "v 1 2 3\nv 3 2 3\nv 3 5 3\nv 1 5 3\nv 1 2 4\nv 3 2 4\nv 3 5 4\nv 1 5 4\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

#[test]
fn help_and_version_go_to_stdout() {
    let folder = Folder::new();
    for line in [
        "--help",
        "--version",
        "bake --help",
        "render -h",
        "info --help",
        "compare --help",
        "report --help",
    ] {
        assert!(!folder.done(line).is_empty(), "{line}");
    }
    assert_eq!(folder.names(), ["cube.obj"]);
}

#[test]
fn the_demo_needs_no_argument() {
    let folder = Folder::new();
    let text = folder.done("");
    assert!(
        text.contains("rhogrid-demo.png") && text.contains("samples"),
        "{text}"
    );
    assert_eq!(folder.names(), ["cube.obj", "rhogrid-demo.png"]);
    let picture = png(&folder.path("rhogrid-demo.png"));
    assert_eq!((picture.width, picture.height), (240, 320));
    let drawn = picture.drawn.iter().filter(|&&drawn| drawn).count();
    assert!(drawn > 240 * 320 / 4, "{drawn} pixels drawn");
}
