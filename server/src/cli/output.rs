//! Output to files, which appear complete or not at all, and to standard output.

use super::failure::Failure;
use super::input::is_stream;
use serde::Serialize;
use std::fs::{self, File, Permissions};
use std::io::{self, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// The destination of an answer.
#[derive(Debug)]
pub(super) enum Destination {
    /// Standard output.
    Stream,
    /// A regular file, existing or not, that is replaced by renaming.
    File(PathBuf),
    /// A device or pipe that must not be replaced.
    Device(PathBuf),
}

impl Destination {
    /// The destination at a path, tested for being writable before any work is done.
    pub(super) fn open(path: &Path) -> Result<Self, Failure> {
        if is_stream(path) {
            return Ok(Self::Stream);
        }
        Self::probe(path).map_err(|source| Failure::Unwritable {
            name: path.display().to_string(),
            source,
        })
    }

    fn probe(path: &Path) -> io::Result<Self> {
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
            Ok(found) if !found.is_file() => Ok(Self::Device(path.into())),
            // The target of a symbolic link is replaced, not the link.
            Ok(_) => {
                temporary_beside(&fs::canonicalize(path)?).map(|(_, target)| Self::File(target))
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                temporary_beside(path).map(|(_, target)| Self::File(target))
            }
            Err(error) => Err(error),
        }
    }

    /// Writes the whole answer.
    pub(super) fn write(&self, content: &(impl AsRef<[u8]> + ?Sized)) -> Result<(), Failure> {
        let content = content.as_ref();
        let (name, result) = match self {
            Self::Stream => return print(content),
            Self::File(path) => (path, replace(path, content)),
            Self::Device(path) => {
                let opened = File::options().write(true).open(path);
                (
                    path,
                    opened.and_then(|mut device| device.write_all(content)),
                )
            }
        };
        result.map_err(|source| Failure::Unwritable {
            name: name.display().to_string(),
            source,
        })
    }
}

/// A temporary file in the folder of a path, and that path: on the same file system, so that
/// renaming is atomic.
fn temporary_beside(path: &Path) -> io::Result<(NamedTempFile, PathBuf)> {
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    // Asked first, because its error is the plain one of the operating system.
    fs::metadata(folder)?;
    let file = tempfile::Builder::new()
        .prefix(".slewplan-")
        // The permissions of any new file, from the caller's umask.
        .permissions(Permissions::from_mode(0o666))
        .tempfile_in(folder)?;
    Ok((file, path.to_owned()))
}

fn replace(path: &Path, content: &[u8]) -> io::Result<()> {
    let (mut file, target) = temporary_beside(path)?;
    file.write_all(content)?;
    file.as_file().sync_all()?;
    file.persist(target)?;
    Ok(())
}

/// A document as JSON text.
pub(super) fn json(document: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(document)
        .map(|text| text + "\n")
        .map_err(|error| Failure::Unspeakable(error.to_string()))
}

/// Writes to standard output.
pub(super) fn print(content: &(impl AsRef<[u8]> + ?Sized)) -> Result<(), Failure> {
    let mut stream = io::stdout().lock();
    match stream
        .write_all(content.as_ref())
        .and_then(|()| stream.flush())
    {
        // A reader that closes the pipe early, such as `head`, is no error.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Unwritable {
            name: "standard output".into(),
            source: error,
        }),
        _ => Ok(()),
    }
}

/// Writes text to standard error.
pub(super) fn remark(text: &str) {
    // An error of standard error cannot be reported.
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Writes a message to standard error.
pub(super) fn complain(message: &str) {
    remark(&format!("slewplan: {message}\n"));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(folder: &Path) -> Vec<String> {
        fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect()
    }

    #[test]
    fn a_file_appears_only_when_written_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.json");
        let destination = Destination::open(&path).unwrap();
        assert!(entries(folder.path()).is_empty());
        destination.write("text").unwrap();
        assert_eq!(entries(folder.path()), ["plan.json"]);
        assert_eq!(fs::read_to_string(&path).unwrap(), "text");
    }

    #[test]
    fn a_link_stays_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        Destination::open(&link).unwrap().write("new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
    }

    #[test]
    fn devices_are_written_to_and_folders_refused() {
        let device = Destination::open(Path::new("/dev/null")).unwrap();
        assert!(matches!(device, Destination::Device(_)));
        device.write("text").unwrap();
        let folder = tempfile::tempdir().unwrap();
        assert!(Destination::open(folder.path()).is_err());
        assert!(Destination::open(&folder.path().join("none/plan.json")).is_err());
    }
}
