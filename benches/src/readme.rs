//! The part of the README that is made here.

use std::path::Path;

use rhogrid::error::Error;
use rhogrid::output::write_whole;

/// The line before it.
const BEGIN: &str = "<!-- Made by benches/run --models FOLDER --write-readme -->\n";
/// The line behind it.
const END: &str = "<!-- End of what benches/run made -->\n";

/// Replaces that part of a file.
///
/// # Errors
/// When the file cannot be read or written, or has no such part.
pub fn write(file: &Path, made: &str) -> Result<(), Error> {
    let text = std::fs::read_to_string(file).map_err(|error| {
        Error::file(
            file,
            format!("cannot be read: {error}"),
            "check that it is there",
        )
    })?;
    let text = replaced(&text, made).ok_or_else(|| {
        let what = format!(
            "has not one line `{}` and one line `{}` behind it",
            BEGIN.trim(),
            END.trim()
        );
        Error::file(file, what, "put them where the tables belong")
    })?;
    write_whole(file, |file| file.write_all(text.as_bytes()))
}

fn replaced(text: &str, made: &str) -> Option<String> {
    let (before, rest) = text.split_once(BEGIN)?;
    let (_, behind) = rest.split_once(END)?;
    let is_once = [before, rest].iter().all(|part| !part.contains(BEGIN)) && !behind.contains(END);
    is_once.then(|| format!("{before}{BEGIN}\n{made}\n{END}{behind}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_part_between_the_marks_is_replaced_as_often_as_one_likes() {
        let text = format!("before\n{BEGIN}old\n{END}behind\n");
        let first = replaced(&text, "new\n").expect("has both marks");
        assert_eq!(first, format!("before\n{BEGIN}\nnew\n\n{END}behind\n"));
        assert_eq!(replaced(&first, "new\n"), Some(first));
    }

    #[test]
    fn marks_that_are_absent_twice_or_turned_round_change_nothing() {
        for text in [
            String::new(),
            format!("{BEGIN}old\n"),
            format!("old\n{END}"),
            format!("{END}old\n{BEGIN}"),
            format!("{BEGIN}{BEGIN}{END}"),
            format!("{BEGIN}{END}{END}"),
            format!("{BEGIN}{END}{BEGIN}"),
        ] {
            assert_eq!(replaced(&text, "new\n"), None, "{text}");
        }
    }

    #[test]
    fn the_readme_has_its_part() {
        let readme = rhogrid_targets::workspace().join("../README.md");
        let text = std::fs::read_to_string(readme).expect("is there");
        assert!(replaced(&text, "").is_some());
    }
}
