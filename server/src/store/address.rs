//! Where a database is, as it is given on the command line.

use sqlx::postgres::PgConnectOptions;
use std::ffi::OsString;
use std::fmt;
use std::path::PathBuf;

/// A file of SQLite, or a database of a Postgres server.
#[derive(Debug, Clone)]
pub(crate) enum DatabaseAddress {
    /// The file.
    File(PathBuf),
    /// The server, with all that is needed to connect.
    Postgres(Box<PgConnectOptions>),
}

impl TryFrom<OsString> for DatabaseAddress {
    type Error = String;

    fn try_from(text: OsString) -> Result<Self, String> {
        let url = text.to_str().filter(|text| {
            let scheme = text.split_once("://").map(|(scheme, _)| scheme);
            matches!(scheme, Some("postgres" | "postgresql"))
        });
        match url {
            // The error of the driver could repeat the password.
            Some(url) => url
                .parse()
                .map(|options| Self::Postgres(Box::new(options)))
                .map_err(|_| "not an address of the form postgres://user@host:5432/name".into()),
            None => Ok(Self::File(text.into())),
        }
    }
}

/// Without the password.
impl fmt::Display for DatabaseAddress {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => write!(formatter, "{}", path.display()),
            Self::Postgres(options) => {
                let place = options.get_socket().map_or_else(
                    || format!("{}:{}", options.get_host(), options.get_port()),
                    |socket| socket.display().to_string(),
                );
                let name = options.get_database().unwrap_or_default();
                write!(formatter, "postgres://{place}/{name}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_of_servers_are_told_from_files_and_shown_without_password() {
        let shown = |text: &str| {
            DatabaseAddress::try_from(OsString::from(text)).map(|address| {
                let is_file = matches!(address, DatabaseAddress::File(_));
                (is_file, address.to_string())
            })
        };
        let server = (false, "postgres://db.example:5433/plans".into());
        assert_eq!(
            shown("postgresql://me:secret@db.example:5433/plans"),
            Ok(server)
        );
        assert_eq!(shown("/data/x.db"), Ok((true, "/data/x.db".into())));
        assert_eq!(shown("postgres.db"), Ok((true, "postgres.db".into())));
        let refused = shown("postgres://me:secret@db.example:port/plans").unwrap_err();
        assert!(!refused.contains("secret"), "{refused}");
    }
}
