//! Answers that are written on another thread as fast as the client reads them.

use super::App;
use super::computing::WorkTurn;
use axum::body::Body;
use axum::http::{HeaderValue, header};
use axum::response::Response;
use bytes::{Bytes, BytesMut};
use futures_util::StreamExt as _;
use futures_util::stream::unfold;
use std::io::{self, Write};
use tokio::sync::mpsc;
use tokio::task::spawn_blocking;

/// Size of the pieces of a body, bytes, and how many of them wait for the client.
const PIECE: usize = 1 << 16;
const WAITING: usize = 4;

/// An answer with a media type whose body some work writes. An error of the work, and a panic, breaks
/// the connection off: a body that ends is whole.
pub(super) fn streamed(
    app: &App,
    turn: WorkTurn,
    form: &'static str,
    work: impl FnOnce(PieceWriter) -> io::Result<PieceWriter> + Send + 'static,
) -> Response {
    let (pieces, received) = mpsc::channel(WAITING);
    let shutdown = app.shutdown().clone();
    spawn_blocking(move || {
        let _turn = turn;
        let writer = PieceWriter {
            pieces,
            waiting: BytesMut::with_capacity(PIECE),
            is_over: Box::new(move || shutdown.has_begun()),
        };
        if let Err(error) = work(writer).and_then(PieceWriter::finish) {
            tracing::warn!(%error, "an answer was not written to its end");
        }
    });
    let body = unfold(Some(received), |received| async move {
        let mut received = received?;
        match received.recv().await {
            Some(Some(piece)) => Some((Ok(piece), Some(received))),
            Some(None) => None,
            None => Some((Err(io::Error::other("not written to its end")), None)),
        }
    });
    // Compression asks once more after the end.
    let mut response = Response::new(Body::from_stream(body.fuse()));
    let form = HeaderValue::from_static(form);
    response.headers_mut().insert(header::CONTENT_TYPE, form);
    response
}

/// Writes the body of an answer; waits while the client does not read.
pub(super) struct PieceWriter {
    /// `None` after the last one.
    pieces: mpsc::Sender<Option<Bytes>>,
    waiting: BytesMut,
    is_over: Box<dyn Fn() -> bool + Send>,
}

impl PieceWriter {
    fn send(&mut self) -> io::Result<()> {
        if (self.is_over)() {
            return Err(io::Error::other("the service is shutting down"));
        }
        let piece = self.waiting.split().freeze();
        let sent = self.pieces.blocking_send(Some(piece));
        sent.map_err(|_| io::Error::other("the client has gone"))
    }

    fn finish(mut self) -> io::Result<()> {
        if !self.waiting.is_empty() {
            self.send()?;
        }
        let sent = self.pieces.blocking_send(None);
        sent.map_err(|_| io::Error::other("the client has gone"))
    }
}

impl Write for PieceWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.waiting.extend_from_slice(bytes);
        if self.waiting.len() >= PIECE {
            self.send()?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
