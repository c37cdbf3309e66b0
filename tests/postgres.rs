//! A Postgres server for the tests of one process, with a new database for each of them.
//!
//! Where Postgres is not installed, nothing is tested on it, unless `SLEWPLAN_TEST_POSTGRES` is
//! `required`.

use sqlx::{AssertSqlSafe, Connection as _, Executor as _, PgConnection};
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

/// A server; it ends with this process, which then lets go of its standard input, or before.
pub(crate) struct Server {
    /// The folder with its socket, and with what its script has made.
    pub(crate) socket: String,
    script: Child,
    answers: BufReader<ChildStdout>,
}

static SERVER: OnceLock<Option<Server>> = OnceLock::new();
static DATABASES: AtomicU32 = AtomicU32::new(0);
const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/postgres.sh");

impl Server {
    /// Starts a server; `None` where Postgres is not installed.
    pub(crate) fn start() -> Option<Self> {
        Self::start_with(&[])
    }

    /// Starts a server with some variables of the environment.
    pub(crate) fn start_with(environment: &[(&str, &str)]) -> Option<Self> {
        let started = Command::new("sh")
            .arg(SCRIPT)
            .envs(environment.iter().copied())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn();
        let mut script = started.expect("a shell");
        let answers = script.stdout.take().expect("standard output is piped");
        let mut server = Self {
            socket: String::new(),
            script,
            answers: BufReader::new(answers),
        };
        server.socket = server.answer();
        if server.socket.is_empty() {
            let status = server.script.wait().expect("it ends");
            let required = std::env::var("SLEWPLAN_TEST_POSTGRES").is_ok_and(|is| is == "required");
            assert!(
                !required && status.code() == Some(3),
                "no Postgres: {status}"
            );
            return None;
        }
        Some(server)
    }

    fn answer(&mut self) -> String {
        let mut line = String::new();
        self.answers.read_line(&mut line).expect("a line");
        line.trim().to_owned()
    }

    /// Ends the server at once, as a crash does.
    pub(crate) fn kill(&mut self) {
        assert_eq!(self.ask("kill"), "killed");
    }

    /// Starts the server again.
    pub(crate) fn restart(&mut self) {
        assert_eq!(self.ask("start"), self.socket);
    }

    fn ask(&mut self, command: &str) -> String {
        let input = self.script.stdin.as_mut().expect("it is piped");
        writeln!(input, "{command}").expect("written");
        self.answer()
    }

    fn url(&self, database: &str) -> String {
        format!(
            "postgres://slewplan@localhost/{database}?host={}",
            self.socket
        )
    }

    /// The address of a new, empty database.
    pub(crate) fn new_database(&self) -> String {
        let name = format!("test_{}", DATABASES.fetch_add(1, Ordering::Relaxed));
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .expect("a runtime");
        runtime.block_on(async {
            let url = self.url("postgres");
            let mut connection = PgConnection::connect(&url).await.expect("connected");
            let create = AssertSqlSafe(format!("CREATE DATABASE {name}"));
            connection.execute(create).await.expect("created");
            connection.close().await.expect("closed");
        });
        self.url(&name)
    }
}

/// The address of a new, empty database of the common server; `None` where Postgres is not installed.
pub(crate) fn new_database() -> Option<String> {
    let server = SERVER.get_or_init(Server::start).as_ref()?;
    Some(server.new_database())
}
