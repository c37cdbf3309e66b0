//! The accept loop: HTTP/1.1 connections with limits on their number and on their patience.
//!
//! A client that is silent, or that sends its request byte by byte, or that does not read its
//! answer, holds one connection for a bounded time. When all connections are taken, the one that
//! has kept the service waiting for a request longest makes room: it takes more than open sockets
//! to keep others out.

mod body;
mod connection_limit;
mod write_timeout;

pub(crate) use body::TooSlow;

use crate::base::lifecycle::Shutdown;
use axum::Router;
use body::{Answer, Arriving};
use connection_limit::{Roster, Seat};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::pin::pin;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use write_timeout::Steady;

/// Time for a request's head to arrive, counted from the end of the answer before it.
const HEAD: Duration = Duration::from_secs(10);
/// Buffer of a connection, which is also the largest head, bytes.
const BUFFER: usize = 64 << 10;
/// Pause after the operating system has refused a connection, most likely for want of files.
const RECOVERY: Duration = Duration::from_millis(100);

/// Takes connections until the service ends, then waits for the requests that are being answered.
/// One of them is kept free, so that who comes next is not kept waiting for another to leave.
pub(crate) async fn serve(listener: TcpListener, router: Router, shutdown: Shutdown, most: usize) {
    let connection_limit = Roster::new(most);
    let mut ending = shutdown.clone();
    loop {
        let taken = async {
            let seat = connection_limit.seat().await;
            (seat, listener.accept().await)
        };
        let (seat, accepted) = tokio::select! {
            taken = taken => taken,
            () = ending.begun() => break,
        };
        match accepted {
            Ok((stream, _)) => {
                seat.begin();
                tokio::spawn(converse(stream, seat, router.clone(), shutdown.clone()));
            }
            Err(error) => {
                tracing::warn!(%error, "a connection could not be accepted");
                tokio::time::sleep(RECOVERY).await;
            }
        }
    }
    drop(listener);
    connection_limit.emptied().await;
}

/// One connection from its first byte to its last.
async fn converse(stream: TcpStream, seat: Seat, router: Router, mut shutdown: Shutdown) {
    // Answers are written whole; waiting for more would only delay them.
    if let Err(error) = stream.set_nodelay(true) {
        tracing::debug!(%error, "a connection waits before it sends");
    }
    let routes = TowerToHyperService::new(router);
    let place = seat.place();
    let service = service_fn(|request: hyper::Request<hyper::body::Incoming>| {
        let (routes, place) = (routes.clone(), place.clone());
        async move {
            let request = request.map(|body| Arriving::new(body, place.clone()));
            let answer = hyper::service::Service::call(&routes, request).await;
            answer.map(|answer| answer.map(|body| Answer::new(body, place)))
        }
    });
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD)
        .max_buf_size(BUFFER)
        .serve_connection(TokioIo::new(Steady::new(stream)), service);
    let mut connection = pin!(connection);
    let ended = tokio::select! {
        ended = connection.as_mut() => ended,
        () = seat.asked_to_leave() => Ok(()),
        () = shutdown.begun() => {
            connection.as_mut().graceful_shutdown();
            connection.await
        }
    };
    if let Err(error) = ended {
        // Clients come and go as they like; nothing is wrong with the service.
        tracing::debug!(%error, "a connection broke");
    }
}
