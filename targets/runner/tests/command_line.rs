//! Exit codes and messages of `targets/run`, as far as they need no QEMU.

use std::process::{Command, Output};

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_run"))
        .args(arguments)
        .output()
        .expect("starts")
}

#[test]
fn wrong_usage_is_2_and_says_what_is_right() {
    for (arguments, message) in [
        (&["m0", "a.rho"][..], "there are sa1110, m3"),
        (
            &["sa1110", "scene.toml", "--light", "1,2,3"],
            "its own lights",
        ),
        (&["sa1110", "a.rho", "--models", "."], "for scenes"),
        (&["sa1110"], "FILE.rho"),
        (&["m3", "a.rho", "--view", "near"], "YAW,PITCH,DISTANCE"),
        (&["m3", "a.rho", "--splat", "x"], "--splat"),
        (&["m3", "a.rho", "--light", "1,2"], "X,Y,Z"),
        (&["m3", "a.rho", "--light", "0,0,0"], "a direction"),
        (&["m3", "a.rho", "--shadow-size", "8"], "--shadow-size"),
    ] {
        let output = run(arguments);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert!(stderr.contains(message), "{arguments:?}: {stderr}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
}

#[test]
fn a_file_that_is_no_asset_is_1_and_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("cut.rho");
    let name = file.to_str().expect("UTF-8");
    for content in [None, Some("RH")] {
        if let Some(content) = content {
            std::fs::write(&file, content).expect("writes");
        }
        let output = run(&["m3", name]);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{stderr}");
        assert!(stderr.contains(name), "{stderr}");
    }
}
