//! What goes wrong: exit code, message, and nothing left behind.

use super::Folder;

/// Exit code 1; the message has all these parts; stdout and folder stay as
/// they were.
#[track_caller]
fn fails(folder: &Folder, line: &str, parts: &[&str]) {
    let before = folder.names();
    let run = folder.run(line);
    assert_eq!(run.code, 1, "{line}: {}{}", run.stdout, run.stderr);
    for part in parts {
        assert!(
            run.stderr.contains(part),
            "{line}: no `{part}` in: {}",
            run.stderr
        );
    }
    assert!(run.stderr.starts_with("error: "), "{line}: {}", run.stderr);
    assert!(!run.stderr.contains("panicked"), "{line}: {}", run.stderr);
    assert_eq!(run.stdout, "", "{line}");
    assert_eq!(folder.names(), before, "{line}");
}

#[track_caller]
fn is_wrong_usage(folder: &Folder, line: &str) {
    let before = folder.names();
    let run = folder.run(line);
    assert_eq!(run.code, 2, "{line}: {}{}", run.stdout, run.stderr);
    assert!(run.stderr.contains("--help"), "{line}: {}", run.stderr);
    assert_eq!(run.stdout, "", "{line}");
    assert_eq!(folder.names(), before, "{line}");
}

#[test]
fn wrong_usage_is_exit_code_2() {
    let folder = Folder::new();
    for line in [
        "paint",
        "--frames 3",
        "bake",
        "bake cube.obj",
        "bake cube.obj -o a.rho --rho 6",
        "bake cube.obj -o a.rho --rho 1",
        "bake cube.obj -o a.rho --level -1",
        "bake cube.obj -o a.rho --level 9",
        "bake cube.obj -o a.rho --rho 5 --level 6",
        "bake cube.obj -o a.rho --up w",
        "bake cube.obj -o a.rho --shell soft",
        "bake cube.obj -o a.rho --normals bent",
        "bake cube.obj -o a.rho --attributes 20",
        "bake cube.obj -o a.rho --max-bytes lots",
        "render cube.obj",
        "render cube.obj -o a.png --size 240",
        "render cube.obj -o a.png --size 0x10",
        "render cube.obj -o a.png --size 5000x10",
        "render cube.obj -o a.png --fov 180",
        "render cube.obj -o a.png --fov nan",
        "render cube.obj -o a.png --yaw inf",
        "render cube.obj -o a.png --distance -1",
        "render cube.obj -o a.png --distance nan",
        "render cube.obj -o a.png --light 0,0,0",
        "render cube.obj -o a.png --light 1,2",
        "render cube.obj -o a.png --light 1,2,x",
        "render cube.obj -o a.png --splat -1",
        "render cube.obj -o a.png --splat nan",
        "render cube.obj -o a.png --distortion -1",
        "render cube.obj -o a.png --distortion nan",
        "render cube.obj -o a.png --path exact --distortion 1",
        "render cube.obj -o a.png --eye 1,2,inf",
        "render cube.obj -o a.png --look-at 0,0,0",
        "render cube.obj -o a.png --eye 9,9,9 --yaw 3",
        "render cube.obj -o a.png --eye 9,9,9 --orbit 3",
        "render cube.obj -o a.png --orbit 0",
        "render cube.obj -o a.png --frames 0",
        "render cube.obj -o a.png --reference --compare",
        "render cube.obj -o a.png --shadow-size 8",
        "render cube.obj -o a.png --shadow-size 4096",
        "render cube.obj -o a.png --shadow-splat -1",
        "render cube.obj -o a.png --shadow-bias nan",
        "render cube.obj -o a.png --level 12",
        "render scene.toml -o a.png --light 1,2,3",
        "render scene.toml -o a.png --level 3",
        "render cube.obj -o a.png --models .",
        "info",
        "compare a.png",
    ] {
        is_wrong_usage(&folder, line);
    }
}

#[test]
fn missing_and_foreign_inputs_are_named() {
    let folder = Folder::new();
    folder.write("empty.obj", "");
    folder.write("text.txt", "hello");
    folder.write("empty.rho", "");
    folder.write("text.rho", "hello, this is no asset at all");
    folder.write("bad.obj", "v 0 0 0\nv 1 x 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
    for (line, parts) in [
        (
            "bake none.obj -o a.rho",
            &["none.obj: ", "cannot be read", "; check"][..],
        ),
        ("bake empty.obj -o a.rho", &["empty.obj: ", "empty", ";"]),
        ("bake text.txt -o a.rho", &["text.txt: ", "unknown", ";"]),
        ("bake bad.obj -o a.rho", &["bad.obj:2: ", ";"]),
        ("bake point.obj -o a.rho", &["point.obj", ";"]),
        (
            "render none.ply -o a.png",
            &["none.ply: ", "cannot be read", "; check"],
        ),
        (
            "render none.rho -o a.png",
            &["none.rho: ", "cannot be read", "; check"],
        ),
        (
            "info none.rho",
            &["none.rho: ", "cannot be read", "; check"],
        ),
        (
            "bake builtin:tree -o a.rho",
            &["builtin:tree: ", "built in", "; give builtin:demo, "],
        ),
        ("info empty.rho", &["empty.rho: ", "byte 0", "; "]),
        ("info text.rho", &["text.rho: ", "byte 0", "rhogrid bake"]),
        (
            "render text.rho -o a.png",
            &["text.rho: ", "byte 0", "rhogrid bake"],
        ),
        ("info cube.obj", &["cube.obj: ", "byte 0", "rhogrid bake"]),
        (
            "compare none.png cube.obj",
            &["none.png: ", "cannot be read", "; check"],
        ),
        (
            "compare cube.obj cube.obj",
            &["cube.obj: ", "not a picture", "; give"],
        ),
    ] {
        fails(&folder, line, parts);
    }
}

#[test]
fn reports_that_cannot_be_made_say_so_before_the_work() {
    let folder = Folder::new();
    is_wrong_usage(&folder, "report --quick --models .");
    is_wrong_usage(&folder, "report cube.obj");
    for (line, parts) in [
        ("report --models .", ["holds no model", "; give"]),
        ("report --models none", ["none: ", "bunny.ply"]),
        (
            "report --quick --out cube.obj",
            ["cube.obj: ", "; name a folder"],
        ),
        (
            "report --quick --machine m3",
            ["targets/run", "; start from"],
        ),
    ] {
        fails(&folder, line, &parts);
    }
    folder.write("bunny.ply", "ply\nformat none\n");
    fails(&folder, "report --models .", &["bunny.ply:2: ", "; "]);
}

#[test]
fn damaged_assets_say_where_and_what_to_do() {
    let folder = Folder::new();
    folder.done("bake cube.obj -o whole.rho --level 2");
    let whole = std::fs::read(folder.path("whole.rho")).unwrap();
    let cut = whole.len() - 6;
    folder.write("cut.rho", &whole[..cut]);
    let place = format!("byte {cut}");
    for line in ["info cut.rho", "render cut.rho -o a.png"] {
        fails(&folder, line, &["cut.rho: ", &place, "; copy it again"]);
    }
    let mut flipped = whole.clone();
    flipped[cut] ^= 1;
    folder.write("flipped.rho", &flipped);
    fails(
        &folder,
        "info flipped.rho",
        &["flipped.rho: ", "byte ", "checksum", "; copy"],
    );
    let mut header = whole.clone();
    header[17] ^= 1;
    folder.write("header.rho", &header);
    fails(
        &folder,
        "info header.rho",
        &["header.rho: ", "byte 60", "checksum", "; copy"],
    );
    let mut version = whole.clone();
    version[4] = 9;
    folder.write("version.rho", &version);
    fails(
        &folder,
        "info version.rho",
        &["version.rho: ", "byte 4", "version 9", "; bake"],
    );
    // An asset under another name is still recognised.
    folder.write("asset.bin", &whole);
    folder.done("info asset.bin");
    folder.done("render asset.bin -o a.png --size 16x16");
}

#[test]
fn assets_have_no_geometry_to_compare_with() {
    let folder = Folder::new();
    folder.done("bake cube.obj -o a.rho --level 1");
    std::fs::copy(folder.path("a.rho"), folder.path("asset.bin")).unwrap();
    for line in [
        "render a.rho -o a.png --compare",
        "render a.rho -o a.png --reference",
        "render asset.bin -o a.png --compare",
        "render asset.bin -o a.png --reference",
    ] {
        let name = line.split_whitespace().nth(1).unwrap();
        fails(&folder, line, &[name, "geometry", "; give the mesh"]);
    }
}

#[test]
fn outputs_are_whole_or_not_there() {
    let folder = Folder::new();
    folder.write("file", "a file, no folder");
    std::fs::create_dir(folder.path("taken")).unwrap();
    folder.done("render cube.obj -o a.png --size 16x16 --level 1");
    for output in ["none/out", "file/out", "taken"] {
        let parts = [output, "; "];
        fails(
            &folder,
            &format!("bake cube.obj -o {output} --level 1"),
            &parts,
        );
        let size = "--size 16x16 --level 1";
        fails(
            &folder,
            &format!("render cube.obj -o {output} {size}"),
            &parts,
        );
        fails(
            &folder,
            &format!("render cube.obj -o {output} {size} --reference"),
            &parts,
        );
        fails(
            &folder,
            &format!("compare a.png a.png --difference {output}"),
            &parts,
        );
    }
    assert_eq!(std::fs::read_dir(folder.path("taken")).unwrap().count(), 0);
}

#[cfg(unix)]
#[test]
fn unwritable_folders_stay_empty() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let locked = folder.path("locked");
    std::fs::create_dir(&locked).unwrap();
    std::fs::set_permissions(&locked, std::fs::Permissions::from_mode(0o555)).unwrap();
    if std::fs::write(locked.join("probe"), "").is_ok() {
        println!("this user may write everywhere: unwritable folders not run");
        return;
    }
    let parts = ["locked/out", "cannot be written", "; check"];
    fails(&folder, "bake cube.obj -o locked/out.rho --level 1", &parts);
    fails(
        &folder,
        "render cube.obj -o locked/out.png --level 1 --size 16x16",
        &parts,
    );
    assert_eq!(std::fs::read_dir(&locked).unwrap().count(), 0);
}

/// A reader that goes away, or a full disk, is a failure like any other.
#[cfg(target_os = "linux")]
#[test]
fn unwritable_stdout_is_exit_code_1() {
    let folder = Folder::new();
    folder.done("bake cube.obj -o a.rho --level 1");
    folder.done("render cube.obj -o a.png --level 1 --size 16x16");
    for line in [
        "info a.rho",
        "info a.rho --json",
        "bake cube.obj -o b.rho --level 1",
        "render a.rho -o b.png --size 16x16",
        "render a.rho -o b.png --size 16x16 --json",
        "render cube.obj -o b.png --size 16x16 --reference",
        "compare a.png a.png",
    ] {
        let full = std::fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let output = folder.command(line).stdout(full).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{line}: {stderr}");
        assert!(
            stderr.starts_with("error: ") && !stderr.contains("panicked"),
            "{line}: {stderr}"
        );
    }
}

#[test]
fn limits_that_cannot_be_kept_name_the_input() {
    let folder = Folder::new();
    fails(
        &folder,
        "bake cube.obj -o a.rho --max-bytes 10",
        &["cube.obj", "10", "; raise --max-bytes"],
    );
    folder.done("render cube.obj -o a.png --level 1 --size 16x16");
    folder.done("render cube.obj -o b.png --level 1 --size 16x17");
    fails(
        &folder,
        "compare a.png b.png",
        &["a.png", "16x16", "b.png", "16x17", "; compare"],
    );
}

#[test]
fn inputs_are_not_replaced_and_links_stay_links() {
    let folder = Folder::new();
    is_wrong_usage(&folder, "bake cube.obj -o cube.obj");
    is_wrong_usage(&folder, "render cube.obj -o cube.png.jpg");
    folder.done("bake cube.obj -o cube.rho --level 1");
    for options in [
        "--rho 2",
        "--level 1",
        "--shell fat",
        "--normals nearest",
        "--up y",
        "--two-sided",
    ] {
        is_wrong_usage(&folder, &format!("render cube.rho -o out.png {options}"));
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("cube.rho", folder.path("link.rho")).unwrap();
        folder.done("bake cube.obj -o link.rho --level 2");
        assert!(folder.path("link.rho").is_symlink());
        let bytes = |name| std::fs::read(folder.path(name)).unwrap();
        assert_eq!(bytes("link.rho"), bytes("cube.rho"));
        fails(
            &folder,
            "bake cube.obj -o /dev/stdout",
            &["no ordinary file"],
        );
    }
}
