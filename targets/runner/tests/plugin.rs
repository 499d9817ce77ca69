//! The counting plugin, executed without QEMU.

use std::process::Command;

use rhogrid_targets::workspace;

#[test]
fn the_plugin_counts_what_it_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let program = folder.path().join("test");
    let compiled = Command::new("cc")
        .args(["-O1", "-Wall", "-Werror", "-o"])
        .args([&program, &workspace().join("plugin/test.c")])
        .output()
        .expect("cc; tests/run installs it");
    let complaint = String::from_utf8_lossy(&compiled.stderr);
    assert!(compiled.status.success(), "{complaint}");
    let output = Command::new(&program).output().expect("starts");
    let failures = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{failures}");
}
