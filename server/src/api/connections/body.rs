//! Bodies of requests with time limits, and bodies of answers that report their end.

use super::connection_limit::ConnectionState;
use axum::body::{Body, Bytes, HttpBody};
use hyper::body::{Frame, Incoming, SizeHint};
use std::error::Error;
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;
use tokio::time::{Instant, Sleep, sleep};

/// Longest time until a body has arrived, and longest pause within it.
const WHOLE: Duration = Duration::from_secs(30);
const PAUSE: Duration = Duration::from_secs(5);

/// A body that did not arrive in time.
#[derive(Debug, thiserror::Error)]
#[error("the body did not arrive within {} s, or paused for {} s", WHOLE.as_secs(), PAUSE.as_secs())]
pub(crate) struct TooSlow;

/// The body of a request.
pub(super) struct TimedRequestBody {
    body: Incoming,
    state: ConnectionState,
    /// The deadline: the end of the longest pause or of the whole time, whichever is earlier.
    deadline: Pin<Box<Sleep>>,
    latest: Instant,
}

impl TimedRequestBody {
    /// A body that arrives on a connection.
    pub(super) fn new(body: Incoming, state: ConnectionState) -> Self {
        let arriving = Self {
            deadline: Box::pin(sleep(PAUSE)),
            latest: Instant::now() + WHOLE,
            body,
            state,
        };
        arriving.notice_end();
        arriving
    }

    fn notice_end(&self) {
        if self.body.is_end_stream() {
            self.state.has_request();
        }
    }
}

impl HttpBody for TimedRequestBody {
    type Data = Bytes;
    type Error = Box<dyn Error + Send + Sync>;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Self::Error>>> {
        if let Poll::Ready(frame) = Pin::new(&mut self.body).poll_frame(context) {
            let next = (Instant::now() + PAUSE).min(self.latest);
            self.deadline.as_mut().reset(next);
            if frame.is_none() {
                self.state.has_request();
            } else {
                self.notice_end();
            }
            return Poll::Ready(frame.map(|frame| frame.map_err(Into::into)));
        }
        ready!(self.deadline.as_mut().poll(context));
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
pub(super) struct ResponseBody {
    body: Body,
    state: ConnectionState,
}

impl ResponseBody {
    /// A body that is sent on a connection.
    pub(super) fn new(body: Body, state: ConnectionState) -> Self {
        Self { body, state }
    }
}

impl Drop for ResponseBody {
    fn drop(&mut self) {
        self.state.has_answer();
    }
}

impl HttpBody for ResponseBody {
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
