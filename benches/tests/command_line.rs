//! Exit codes and messages of `benches/run`, as far as they need neither
//! valgrind nor QEMU.

use std::process::{Command, Output};

fn benches(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_benches"))
        .args(arguments)
        // No valgrind.
        .env("PATH", "")
        .output()
        .expect("starts")
}

fn check(arguments: &[&str], code: i32, message: &str) {
    let output = benches(arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    assert!(stderr.contains(message), "{arguments:?}: {stderr}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
}

#[test]
fn wrong_usage_is_2() {
    check(&["bunny.ply"], 2, "bunny.ply");
    check(&["--write-readme"], 2, "--models");
    check(&["--quick", "--models", "."], 2, "--models");
}

#[test]
fn what_is_absent_is_1_and_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let name = folder.path().to_str().expect("UTF-8");
    check(&["--models", name], 1, &format!("{name}/bunny.ply: "));
    check(&["--quick"], 1, "apt-get install valgrind");
}
