//! Bodies on their way: requests that have to arrive in time, answers whose end is noticed.

use super::connection_limit::Place;
use axum::body::{Body, Bytes, HttpBody};
use hyper::body::{Frame, Incoming, SizeHint};
use std::error::Error;
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;
use tokio::time::{Instant, Sleep, sleep};

/// Longest time for a body to arrive, and longest pause within it.
const WHOLE: Duration = Duration::from_secs(30);
const PAUSE: Duration = Duration::from_secs(5);

/// A body that did not arrive in time.
#[derive(Debug, thiserror::Error)]
#[error("the body did not arrive within {} s, or paused for {} s", WHOLE.as_secs(), PAUSE.as_secs())]
pub(crate) struct TooSlow;

/// The body of a request.
pub(super) struct Arriving {
    body: Incoming,
    place: Place,
    /// Rings at the end of a pause or of the whole time, whichever is earlier.
    alarm: Pin<Box<Sleep>>,
    latest: Instant,
}

impl Arriving {
    /// A body that is to arrive at a place.
    pub(super) fn new(body: Incoming, place: Place) -> Self {
        let arriving = Self {
            alarm: Box::pin(sleep(PAUSE)),
            latest: Instant::now() + WHOLE,
            body,
            place,
        };
        arriving.notice_end();
        arriving
    }

    fn notice_end(&self) {
        if self.body.is_end_stream() {
            self.place.has_request();
        }
    }
}

impl HttpBody for Arriving {
    type Data = Bytes;
    type Error = Box<dyn Error + Send + Sync>;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Self::Error>>> {
        if let Poll::Ready(frame) = Pin::new(&mut self.body).poll_frame(context) {
            let next = (Instant::now() + PAUSE).min(self.latest);
            self.alarm.as_mut().reset(next);
            if frame.is_none() {
                self.place.has_request();
            } else {
                self.notice_end();
            }
            return Poll::Ready(frame.map(|frame| frame.map_err(Into::into)));
        }
        ready!(self.alarm.as_mut().poll(context));
        Poll::Ready(Some(Err(TooSlow.into())))
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

/// The body of an answer.
pub(super) struct Answer {
    body: Body,
    place: Place,
}

impl Answer {
    /// A body that is sent from a place.
    pub(super) fn new(body: Body, place: Place) -> Self {
        Self { body, place }
    }
}

impl Drop for Answer {
    fn drop(&mut self) {
        self.place.has_answer();
    }
}

impl HttpBody for Answer {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        Pin::new(&mut self.body).poll_frame(context)
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}
