//! The accept loop: HTTP/1.1 connections with limits on their number and their idle times.
//!
//! A client that is silent, sends its request byte by byte or does not read its answer holds a
//! connection for a bounded time. When all connections are taken, the one that has waited longest
//! for a request is closed, so that idle connections cannot block others.

mod body;
mod connection_limit;
mod write_timeout;

pub(crate) use body::TooSlow;

use crate::base::lifecycle::Shutdown;
use axum::Router;
use body::{ResponseBody, TimedRequestBody};
use connection_limit::{ConnectionLimit, ConnectionPermit};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::pin::pin;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use write_timeout::WriteTimeout;

/// Longest time until a request's head has arrived, from the end of the answer before it.
const HEAD: Duration = Duration::from_secs(10);
/// Size of a connection's buffer, which limits the head of a request, bytes.
const BUFFER: usize = 64 << 10;
/// Pause after a failed accept, most often for lack of file descriptors.
const RECOVERY: Duration = Duration::from_millis(100);

/// Accepts connections until the service ends, then waits for open requests. A permit is taken
/// before each accept, so that a new connection does not wait for the eviction of another.
pub(crate) async fn serve(listener: TcpListener, router: Router, shutdown: Shutdown, most: usize) {
    let connection_limit = ConnectionLimit::new(most);
    let mut ending = shutdown.clone();
    loop {
        let taken = async {
            let permit = connection_limit.permit().await;
            (permit, listener.accept().await)
        };
        let (permit, accepted) = tokio::select! {
            taken = taken => taken,
            () = ending.begun() => break,
        };
        match accepted {
            Ok((stream, _)) => {
                permit.begin();
                tokio::spawn(serve_connection(
                    stream,
                    permit,
                    router.clone(),
                    shutdown.clone(),
                ));
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

/// Serves one connection until it is closed, evicted or the service ends.
async fn serve_connection(
    stream: TcpStream,
    permit: ConnectionPermit,
    router: Router,
    mut shutdown: Shutdown,
) {
    // Answers are written in one piece; Nagle's algorithm would only delay them.
    if let Err(error) = stream.set_nodelay(true) {
        tracing::debug!(%error, "TCP_NODELAY cannot be set");
    }
    let routes = TowerToHyperService::new(router);
    let state = permit.state();
    let service = service_fn(|request: hyper::Request<hyper::body::Incoming>| {
        let (routes, state) = (routes.clone(), state.clone());
        async move {
            let request = request.map(|body| TimedRequestBody::new(body, state.clone()));
            let answer = hyper::service::Service::call(&routes, request).await;
            answer.map(|answer| answer.map(|body| ResponseBody::new(body, state)))
        }
    });
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD)
        .max_buf_size(BUFFER)
        .serve_connection(TokioIo::new(WriteTimeout::new(stream)), service);
    let mut connection = pin!(connection);
    let ended = tokio::select! {
        ended = connection.as_mut() => ended,
        () = permit.evicted() => Ok(()),
        () = shutdown.begun() => {
            connection.as_mut().graceful_shutdown();
            connection.await
        }
    };
    if let Err(error) = ended {
        // Usually the client has disconnected, which is no error of the service.
        tracing::debug!(%error, "a connection broke");
    }
}
