//! The accepted pictures and hashes on disk.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use rhogrid::cli::Frame;
use rhogrid::measure::difference;
use rhogrid::picture::Picture;

use super::cases::Case;

const COMMAND: &str = "RHOGRID_ACCEPT=1 cargo test --test golden";

fn frames_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/frames")
}

fn picture_path(name: &str) -> PathBuf {
    frames_folder().join(format!("{name}.png"))
}

fn hashes_path() -> PathBuf {
    frames_folder().join("hashes.txt")
}

/// The accepted hashes by case.
fn accepted_hashes() -> BTreeMap<String, String> {
    let text = fs::read_to_string(hashes_path()).unwrap_or_default();
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .filter_map(|line| line.split_once(' '))
        .map(|(hash, name)| (name.to_owned(), hash.to_owned()))
        .collect()
}

fn hash_of(frame: &Frame) -> String {
    format!("{:08x}", frame.hash())
}

/// Makes all frames the accepted ones and removes what no case draws.
pub fn accept(frames: &[(&Case, Frame)]) {
    fs::create_dir_all(frames_folder()).unwrap();
    let mut text = format!("# Written by: {COMMAND}\n");
    for (case, frame) in frames {
        text += &format!("{} {}\n", hash_of(frame), case.name);
        let path = picture_path(case.name);
        let is_kept = Picture::load(&path).is_ok_and(|kept| kept == seen(frame));
        if case.is_pictured && !is_kept {
            save(&seen(frame), &path);
            println!("accepted {}", path.display());
        }
    }
    fs::write(hashes_path(), text).unwrap();
    for stray in strays(frames) {
        fs::remove_file(stray).unwrap();
    }
}

/// One line for every frame that is not the accepted one.
pub fn failures(frames: &[(&Case, Frame)]) -> Vec<String> {
    let hashes = accepted_hashes();
    let mut failures: Vec<String> = frames
        .iter()
        .filter_map(|(case, frame)| failure(case, frame, hashes.get(case.name)))
        .collect();
    let names: Vec<&str> = frames.iter().map(|(case, _)| case.name).collect();
    let unknown = hashes.keys().filter(|name| !names.contains(&name.as_str()));
    failures.extend(unknown.map(|name| format!("{name}: a hash without a case")));
    let strays = strays(frames);
    failures.extend(
        strays
            .iter()
            .map(|path| format!("{}: no case draws it", path.display())),
    );
    failures
}

/// Pictures that belong to no case.
fn strays(frames: &[(&Case, Frame)]) -> Vec<PathBuf> {
    let pictured: Vec<PathBuf> = frames
        .iter()
        .filter(|(case, _)| case.is_pictured)
        .map(|(case, _)| picture_path(case.name))
        .chain([hashes_path()])
        .collect();
    let Ok(entries) = fs::read_dir(frames_folder()) else {
        return Vec::new();
    };
    entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| !pictured.contains(path))
        .collect()
}

fn failure(case: &Case, frame: &Frame, hash: Option<&String>) -> Option<String> {
    let actual = seen(frame);
    let accepted = case
        .is_pictured
        .then(|| Picture::load(&picture_path(case.name)));
    let same_hash = hash.is_some_and(|hash| *hash == hash_of(frame));
    let same_picture = match &accepted {
        None => true,
        Some(Ok(accepted)) => *accepted == actual,
        Some(Err(_)) => false,
    };
    if same_hash && same_picture {
        return None;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{}-actual.png", case.name));
    save(&actual, &path);
    let mut line = format!(
        "{}: hash {}, accepted {}\n  actual     {}",
        case.name,
        hash_of(frame),
        hash.map_or("none", String::as_str),
        path.display()
    );
    if let Some(Ok(accepted)) = accepted
        && let Ok(apart) = difference(&accepted, &actual)
    {
        let path = folder.join(format!("{}-difference.png", case.name));
        save(&apart, &path);
        line += &format!("\n  difference {}", path.display());
    }
    line += &format!("\n  accept all with {COMMAND}");
    Some(line)
}

/// The picture as a file keeps it: black where nothing was drawn.
fn seen(frame: &Frame) -> Picture {
    let picture = frame.picture();
    Picture {
        rgb: picture.seen().collect(),
        ..picture
    }
}

/// Writes a PNG as small as the encoder makes it.
fn save(picture: &Picture, path: &Path) {
    let alpha = picture
        .drawn
        .iter()
        .map(|&drawn| if drawn { 255 } else { 0 });
    let rgba: Vec<u8> = picture
        .rgb
        .iter()
        .zip(alpha)
        .flat_map(|([red, green, blue], alpha)| [*red, *green, *blue, alpha])
        .collect();
    let file = fs::File::create(path).unwrap();
    PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive)
        .write_image(
            &rgba,
            picture.width,
            picture.height,
            ExtendedColorType::Rgba8,
        )
        .unwrap();
}
