//! The material files of an OBJ file.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use super::super::shown;
use super::lines::{Statement, each_statement, number, text, words};
use crate::error::{Error, Place};

/// Clean MTL text (`newmtl` and `Kd r g b` alone) of every file that a
/// `mtllib` statement names. A file that cannot be read is a note, and its
/// materials stay white.
pub(super) fn libraries(
    obj: &Path,
    statements: &[(usize, String)],
    notes: &mut Vec<String>,
) -> Result<String, Error> {
    let mut clean = String::new();
    for (line, names) in statements {
        for (name, path) in paths(obj, names) {
            match path.map(|path| Ok((fs::read(&path)?, path))) {
                Some(Ok((bytes, path))) => read(&path, &text(&bytes), &mut clean, notes)?,
                Some(Err::<_, std::io::Error>(error)) => {
                    notes.push(format!(
                        "line {line}: material file `{}` cannot be read ({error}): white",
                        shown(name)
                    ));
                }
                None => notes.push(format!(
                    "line {line}: material file `{}` not found: white",
                    shown(name)
                )),
            }
        }
    }
    Ok(clean)
}

/// The files that a statement names: one whose name may hold blanks, or
/// else several.
fn paths<'a>(obj: &Path, names: &'a str) -> Vec<(&'a str, Option<PathBuf>)> {
    let folder = obj.parent().unwrap_or(Path::new(""));
    let find = |name: &str| {
        let candidates = [folder.join(name), folder.join(name.replace('\\', "/"))];
        // A device or a pipe might never end.
        candidates.into_iter().find(|path| path.is_file())
    };
    match find(names) {
        Some(path) => vec![(names, Some(path))],
        None if words(names).any(|name| find(name).is_some()) => {
            words(names).map(|name| (name, find(name))).collect()
        }
        None => vec![(names, None)],
    }
}

/// Checks one material file and appends what counts to `clean`.
fn read(file: &Path, text: &str, clean: &mut String, notes: &mut Vec<String>) -> Result<(), Error> {
    let mut begun = false;
    let mut textures = 0;
    each_statement(
        text,
        |Statement {
             line,
             keyword,
             rest,
         }| {
            let failed = |what: String| {
                Err(Error::at(
                    file,
                    Place::Line(line),
                    what,
                    "write a colour as Kd and three numbers from 0 to 1",
                ))
            };
            match keyword {
                "newmtl" if rest.is_empty() => {
                    return Err(Error::at(
                        file,
                        Place::Line(line),
                        "`newmtl` without a name",
                        "name it",
                    ));
                }
                "newmtl" => {
                    begun = true;
                    // Writing to a String cannot fail.
                    let _ = writeln!(clean, "newmtl {rest}");
                }
                "Kd" if !begun => return failed("`Kd` before the first `newmtl`".to_owned()),
                "Kd" => match diffuse(rest) {
                    Ok(Some([r, g, b])) => {
                        let _ = writeln!(clean, "Kd {r} {g} {b}");
                    }
                    Ok(None) => notes.push(format!(
                        "{}:{line}: spectral and CIE colours not used: white",
                        file_name(file)
                    )),
                    Err(what) => return failed(what),
                },
                "map_Kd" => textures += 1,
                _ => {}
            }
            Ok(())
        },
    )?;
    if textures > 0 {
        let textures = super::super::surface::count(textures, "texture");
        notes.push(format!("{textures} of {} not used", file_name(file)));
    }
    Ok(())
}

fn file_name(file: &Path) -> std::borrow::Cow<'_, str> {
    file.file_name().unwrap_or_default().to_string_lossy()
}

/// The three numbers of a colour; one number is a grey.
fn diffuse(rest: &str) -> Result<Option<[f64; 3]>, String> {
    if matches!(words(rest).next(), Some("spectral" | "xyz")) {
        return Ok(None);
    }
    let numbers: Vec<f64> = words(rest).map(number).collect::<Result<_, _>>()?;
    match numbers[..] {
        [grey] => Ok(Some([grey; 3])),
        [r, g, b, ..] => Ok(Some([r, g, b])),
        _ => Err(format!("a colour of {} numbers", numbers.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clean(text: &str) -> Result<String, String> {
        let mut clean = String::new();
        let done = read("a.mtl".as_ref(), text, &mut clean, &mut Vec::new());
        done.map(|()| clean).map_err(|error| error.to_string())
    }

    #[test]
    fn only_names_and_diffuse_colours_stay() {
        let text = "\n newmtl a b\r\nKa 1\nKd .5 \\\n 0 1 # c\nnewmtl c\nKd 0.25\nmap_Kd";
        assert_eq!(
            clean(text).unwrap(),
            "newmtl a b\nKd 0.5 0 1\nnewmtl c\nKd 0.25 0.25 0.25\n"
        );
    }

    #[test]
    fn bad_colours_name_their_line() {
        for (text, line) in [
            ("newmtl a\nKd 1 2", "2"),
            ("Kd 1", "1"),
            ("newmtl a\n\nKd nan", "3"),
            ("newmtl", "1"),
        ] {
            let error = clean(text).unwrap_err();
            assert!(error.starts_with(&format!("a.mtl:{line}: ")), "{error}");
        }
    }
}
