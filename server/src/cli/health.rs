//! `slewplan health`: asks a running service whether it can take work.
//!
//! For container images that have neither a shell nor an HTTP client.

use super::Exit;
use super::failure::Failure;
use std::io::{self, Read, Write};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpStream};
use std::time::{Duration, Instant};

/// Maximum size of an answer, far above any answer of these routes, bytes.
const LARGEST: usize = 64 << 10;

/// Arguments of `health`.
#[derive(Debug, clap::Args)]
pub(super) struct HealthArguments {
    /// Address on which the service listens
    #[arg(long, env = "SLEWPLAN_LISTEN", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    /// Check only that the process answers, not that it can take work
    #[arg(long)]
    live: bool,
    /// Longest wait for the answer, s
    #[arg(long, value_name = "S", default_value_t = 10,
        value_parser = clap::value_parser!(u16).range(1..))]
    timeout: u16,
}

/// Sends one request and reports the answer.
pub(super) fn run(arguments: &HealthArguments) -> Result<Exit, Failure> {
    let address = reachable(arguments.listen)?;
    let route = if arguments.live {
        "/health/live"
    } else {
        "/health/ready"
    };
    let patience = Duration::from_secs(arguments.timeout.into());
    match ask(address, route, patience).map(|answer| complaint(&answer)) {
        Ok(None) => Ok(Exit::Complete),
        Ok(Some(what)) => Err(Failure::Unhealthy {
            address,
            route,
            what,
        }),
        Err(error) => Err(Failure::Unhealthy {
            address,
            route,
            what: error.to_string(),
        }),
    }
}

/// The address of a service for its own machine: a service that listens on all addresses is reached
/// on the loopback address.
fn reachable(listen: SocketAddr) -> Result<SocketAddr, Failure> {
    if listen.port() == 0 {
        return Err(Failure::Setting {
            name: "--listen",
            what: "port 0 stands for any free port; name the port that the service printed".into(),
        });
    }
    let ip = match listen.ip() {
        IpAddr::V4(Ipv4Addr::UNSPECIFIED) => Ipv4Addr::LOCALHOST.into(),
        IpAddr::V6(Ipv6Addr::UNSPECIFIED) => Ipv6Addr::LOCALHOST.into(),
        ip => ip,
    };
    Ok(SocketAddr::new(ip, listen.port()))
}

/// Sends a request and returns the whole answer, within a time limit.
fn ask(address: SocketAddr, route: &str, patience: Duration) -> io::Result<Vec<u8>> {
    let end = Instant::now() + patience;
    let mut stream = TcpStream::connect_timeout(&address, patience)?;
    stream.set_write_timeout(Some(patience))?;
    // In one write: a server that answers and closes after a first part would break a second write.
    let request = format!("GET {route} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n");
    stream.write_all(request.as_bytes())?;
    let mut answer = Vec::new();
    let mut part = [0; 4096];
    loop {
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
        stream.set_read_timeout(Some(left))?;
        match stream.read(&mut part) {
            Ok(0) => return Ok(answer),
            Ok(count) => answer.extend_from_slice(&part[..count]),
            // The operating system's error for an expired timeout.
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                return Err(io::ErrorKind::TimedOut.into());
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
        if answer.len() > LARGEST {
            return Err(io::Error::new(
                io::ErrorKind::InvalidData,
                "the answer is not that of a slewplan service",
            ));
        }
    }
}

/// Why an answer is negative; `None` if the service is healthy.
fn complaint(answer: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(answer);
    let (head, body) = text.split_once("\r\n\r\n").unwrap_or((&text, ""));
    let mut status = head.lines().next().unwrap_or_default().splitn(3, ' ');
    let protocol = status.next().unwrap_or_default();
    let code = status.next().filter(|_| protocol.starts_with("HTTP/1."));
    match code {
        Some("200") => None,
        Some(code) => {
            let document = serde_json::from_str::<serde_json::Value>(body).unwrap_or_default();
            let detail = document["detail"].as_str().unwrap_or("no reason given");
            Some(format!("{code}, {detail}"))
        }
        None => Some("the answer is not HTTP".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;
    use std::thread;

    /// Sends a request to a server that answers with these bytes and closes, or never answers.
    #[expect(clippy::disallowed_methods, reason = "a test may panic")]
    fn ask_one_that_says(answer: Option<&'static str>, patience: Duration) -> io::Result<Vec<u8>> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let address = listener.local_addr().unwrap();
        let answering = thread::spawn(move || {
            let (mut stream, _) = listener.accept().unwrap();
            let mut request = [0; 1024];
            let count = stream.read(&mut request).unwrap();
            if let Some(answer) = answer {
                stream.write_all(answer.as_bytes()).unwrap();
            } else {
                // Until the client has closed the connection.
                let _ = stream.read(&mut request[count..]);
            }
            String::from_utf8_lossy(&request[..count]).into_owned()
        });
        let got = ask(address, "/health/ready", patience);
        let request = answering.join().unwrap();
        assert!(
            request.starts_with("GET /health/ready HTTP/1.1\r\n"),
            "{request}"
        );
        got
    }

    #[test]
    fn every_address_is_asked_on_loopback() {
        for (listen, asked) in [
            ("0.0.0.0:8080", "127.0.0.1:8080"),
            ("[::]:80", "[::1]:80"),
            ("10.1.2.3:80", "10.1.2.3:80"),
        ] {
            assert_eq!(
                reachable(listen.parse().unwrap()).unwrap(),
                asked.parse().unwrap()
            );
        }
        let free = reachable("127.0.0.1:0".parse().unwrap()).unwrap_err();
        assert_eq!(free.exit(), Exit::Invalid);
    }

    #[test]
    fn answers_are_understood_whole() {
        let patience = Duration::from_secs(30);
        let healthy = "HTTP/1.1 200 OK\r\ncontent-length: 2\r\n\r\n{}";
        let answer = ask_one_that_says(Some(healthy), patience).unwrap();
        assert_eq!(answer, healthy.as_bytes());
        assert_eq!(complaint(&answer), None);
        let ill = "HTTP/1.1 503 Service Unavailable\r\n\r\n{\"detail\": \"the queue is full\"}";
        assert_eq!(
            complaint(ill.as_bytes()).as_deref(),
            Some("503, the queue is full")
        );
        for strange in [
            "",
            "SSH-2.0-x\r\n",
            "HTTP/1.1\r\n\r\n",
            "200 200 200\r\n\r\n",
        ] {
            assert!(complaint(strange.as_bytes()).is_some(), "{strange:?}");
        }
    }

    #[test]
    fn silence_is_not_waited_for_longer_than_asked() {
        let begin = Instant::now();
        let error = ask_one_that_says(None, Duration::from_millis(200)).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::TimedOut);
        assert!(begin.elapsed() < Duration::from_secs(20));
    }
}
