//! Requests against a running service: as many as it takes, or at a fixed rate.
//!
//! ```text
//! load ADDRESS closed CLIENTS SECONDS PATH [BODY-FILE]     each client asks again at once
//! load ADDRESS open RATE SECONDS PATH [BODY-FILE]          RATE requests per second in all
//! ```
//!
//! At a fixed rate latencies count from the moment when a request was due, so that a service that
//! stalls is not spared the requests it kept from being sent. Prints one JSON object: answers by
//! status, those of 429 and 503 without `Retry-After`, the rate, and latencies in milliseconds.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Connections of an open loop: more than a service that keeps up ever needs.
const OPEN_CLIENTS: u32 = 32;

/// What a client has seen.
#[derive(Default)]
struct Seen {
    statuses: BTreeMap<u16, u64>,
    impolite: u64,
    accepted: Vec<Duration>,
    refused: Vec<Duration>,
}

struct Client {
    address: String,
    request: Vec<u8>,
    stream: Option<BufReader<TcpStream>>,
}

impl Client {
    /// The status of an answer and whether it says when to come again; 0 for a broken connection.
    fn ask(&mut self) -> (u16, bool) {
        self.exchange().unwrap_or_else(|_| {
            self.stream = None;
            (0, false)
        })
    }

    fn exchange(&mut self) -> std::io::Result<(u16, bool)> {
        if self.stream.is_none() {
            let stream = TcpStream::connect(&self.address)?;
            stream.set_nodelay(true)?;
            stream.set_read_timeout(Some(Duration::from_secs(30)))?;
            self.stream = Some(BufReader::new(stream));
        }
        let Some(stream) = &mut self.stream else {
            return Ok((0, false));
        };
        stream.get_mut().write_all(&self.request)?;
        let (mut status, mut length, mut again, mut line) = (0, 0, false, String::new());
        let mut close = false;
        loop {
            line.clear();
            if stream.read_line(&mut line)? == 0 {
                return Err(std::io::ErrorKind::UnexpectedEof.into());
            }
            let line = line.trim_end().to_ascii_lowercase();
            if line.is_empty() {
                break;
            } else if let Some(rest) = line.strip_prefix("http/1.1 ") {
                status = rest
                    .split(' ')
                    .next()
                    .and_then(|s| s.parse().ok())
                    .unwrap_or(0);
            } else if let Some(rest) = line.strip_prefix("content-length: ") {
                length = rest.parse().unwrap_or(0);
            } else if line.starts_with("retry-after: ") {
                again = true;
            } else if line == "connection: close" {
                close = true;
            }
        }
        std::io::copy(&mut stream.take(length), &mut std::io::sink())?;
        if close {
            self.stream = None;
        }
        Ok((status, again))
    }
}

/// Asks until the end: at once again, or when the next request of all clients is due.
#[expect(
    clippy::disallowed_methods,
    reason = "waits for the time of the next request"
)]
fn run(mut client: Client, begin: Instant, end: Instant, rate: Option<(f64, &AtomicU64)>) -> Seen {
    let mut seen = Seen::default();
    loop {
        let due = match rate {
            None => Instant::now(),
            Some((rate, next)) => {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let due = begin + Duration::from_secs_f64(number as f64 / rate);
                std::thread::sleep(due.saturating_duration_since(Instant::now()));
                due
            }
        };
        if due >= end {
            return seen;
        }
        let (status, again) = client.ask();
        let took = due.elapsed();
        *seen.statuses.entry(status).or_default() += 1;
        if matches!(status, 429 | 503) {
            seen.impolite += u64::from(!again);
            seen.refused.push(took);
        } else {
            seen.accepted.push(took);
        }
    }
}

fn quantiles(mut latencies: Vec<Duration>) -> String {
    latencies.sort_unstable();
    let last = latencies.len().saturating_sub(1);
    let at = |per_mille: usize| {
        let value = latencies.get((latencies.len() * per_mille / 1000).min(last));
        value.map_or(0.0, |value| value.as_secs_f64() * 1e3)
    };
    let (median, p99, p999, worst) = (at(500), at(990), at(999), at(1000));
    format!("{{\"p50\":{median:.3},\"p99\":{p99:.3},\"p999\":{p999:.3},\"max\":{worst:.3}}}")
}

#[expect(clippy::disallowed_methods, reason = "ends before anything has begun")]
fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [address, mode, amount, seconds, path, body @ ..] = arguments.as_slice() else {
        eprintln!("usage: load ADDRESS closed|open CLIENTS|RATE SECONDS PATH [BODY-FILE]");
        std::process::exit(2);
    };
    let body = body
        .first()
        .map(|file| std::fs::read(file).expect("the body can be read"));
    let mut request = match &body {
        None => format!("GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n"),
        Some(body) => format!(
            "POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n\
             Content-Length: {}\r\n\r\n",
            body.len()
        ),
    }
    .into_bytes();
    request.extend(body.unwrap_or_default());
    let amount: u32 = amount.parse().expect("a number");
    let seconds = Duration::from_secs_f64(seconds.parse().expect("a number"));
    let is_open = mode == "open";
    let clients = if is_open { OPEN_CLIENTS } else { amount };
    let next = AtomicU64::new(0);
    let (begin, next) = (Instant::now(), &next);
    let all: Vec<Seen> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..clients)
            .map(|_| {
                let client = Client {
                    address: address.clone(),
                    request: request.clone(),
                    stream: None,
                };
                let rate = is_open.then_some((f64::from(amount), next));
                scope.spawn(move || run(client, begin, begin + seconds, rate))
            })
            .collect();
        threads
            .into_iter()
            .map(|thread| thread.join().expect("a client"))
            .collect()
    });
    let took = begin.elapsed().as_secs_f64();
    let mut total = Seen::default();
    for seen in all {
        for (status, count) in seen.statuses {
            *total.statuses.entry(status).or_default() += count;
        }
        total.impolite += seen.impolite;
        total.accepted.extend(seen.accepted);
        total.refused.extend(seen.refused);
    }
    let statuses: Vec<String> = total
        .statuses
        .iter()
        .map(|(status, count)| format!("\"{status}\":{count}"))
        .collect();
    let count = total.accepted.len() + total.refused.len();
    println!(
        "{{\"statuses\":{{{}}},\"impolite\":{},\"per_second\":{:.1},\"accepted_ms\":{},\"refused_ms\":{}}}",
        statuses.join(","),
        total.impolite,
        count as f64 / took,
        quantiles(total.accepted),
        quantiles(total.refused)
    );
}
