//! Output files, whole or not at all: written to a temporary name in the same
//! folder, then renamed. A failure leaves what was there before.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use crate::error::Error;

/// Writes a file with `fill`. Replaces a file of that name; refuses a folder or
/// a device.
///
/// # Errors
///
/// Whatever `fill` returns, and whatever the file system has against the file.
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Error> {
    // A link stays, and the file that it leads to is replaced.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let is_special = ["/dev", "/proc", "/sys"]
        .iter()
        .any(|folder| [path, &target].iter().any(|path| path.starts_with(folder)));
    if is_special || target.metadata().is_ok_and(|existing| !existing.is_file()) {
        return Err(Error::file(
            path,
            "exists and is no ordinary file",
            "choose another name",
        ));
    }
    let (shown, path) = (path, target.as_path());
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    fill_and_rename(path, folder, fill).map_err(|error| {
        let remedy = "check that its folder exists, may be written to and has room";
        Error::file(shown, format!("cannot be written: {error}"), remedy)
    })
}

fn fill_and_rename(
    path: &Path,
    folder: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut options = tempfile::Builder::new();
    options.prefix(".rhogrid-");
    // Like any new file, readable as far as the user's mask allows; temporary
    // files are the owner's alone by default.
    #[cfg(unix)]
    options.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = options.tempfile_in(folder)?;
    let mut writer = BufWriter::new(file.as_file_mut());
    fill(&mut writer)?;
    writer.flush()?;
    drop(writer);
    file.persist(path)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_failure_keeps_the_old_file_and_leaves_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.bin");
        write_whole(&path, |file| file.write_all(b"old")).unwrap();
        let failed = write_whole(&path, |file| {
            file.write_all(b"half of the new")?;
            Err(io::Error::other("the encoder gave up"))
        });
        let message = failed.unwrap_err().to_string();
        assert!(
            message.contains("frame.bin") && message.contains("gave up"),
            "{message}"
        );
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);

        write_whole(&path, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn folders_and_missing_folders_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let refused = write_whole(folder.path(), |_| Ok(())).unwrap_err();
        assert!(
            refused.to_string().contains("no ordinary file"),
            "{refused}"
        );
        assert!(write_whole(&folder.path().join("none/a.bin"), |_| Ok(())).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_any_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
        write_whole(&ours, |_| Ok(())).unwrap();
        fs::write(&plain, "").unwrap();
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }
}
