//! What the processes on one database tell each other: LISTEN and NOTIFY of Postgres.
//!
//! A notice says where to look, never what there is: who misses one finds the same later, by looking
//! at intervals. So it is sent after its commit, on a connection whose commits wait for no disk:
//! notices of all processes follow one another through one lock of the server. SQLite, whose
//! service is one process, needs none.

use super::database::Database;
use super::database::postgres::PostgresDatabase;
use super::{Store, StoreError};
use sqlx::PgPool;
use sqlx::postgres::{PgListener, PgNotification};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::sync::{Notify, oneshot};

const CHANNEL: &str = "slewplan";
/// Pause before another try to listen.
const RETRY: Duration = Duration::from_secs(1);
/// Maximum number of notices sent at once.
const BATCH: usize = 256;
/// Longest wait for the last notices before the connections are closed.
const FLUSH: Duration = Duration::from_secs(2);

/// Something that has been committed.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Notice {
    /// A job has been queued.
    Queued,
    /// Some job has changed.
    Changed,
    /// A job shall stop or be cancelled, or has been deleted.
    Requested(String),
    /// A key has been made.
    Keys,
    /// Notices may have been missed.
    Missed,
}

impl Notice {
    fn text(&self) -> String {
        match self {
            Self::Queued => "queued".into(),
            Self::Keys => "keys".into(),
            Self::Changed | Self::Missed => "changed".into(),
            Self::Requested(id) => format!("requested {id}"),
        }
    }

    /// The notice of a text, which may be that of a newer version.
    fn of(text: &str) -> Self {
        match text.split_once(' ') {
            Some(("requested", id)) => Self::Requested(id.to_owned()),
            _ if text == "queued" => Self::Queued,
            _ if text == "keys" => Self::Keys,
            _ => Self::Changed,
        }
    }
}

/// An entry of the queue of notices.
#[derive(Debug)]
enum Entry {
    /// A notice.
    Notice(Notice),
    /// Somebody waits until the entries before have been sent.
    Flush(oneshot::Sender<()>),
}

/// Sends notices to other processes, in the order in which they were given, those that came while
/// others were sent all at once.
#[derive(Debug, Clone)]
pub(super) struct Notices {
    queue: UnboundedSender<Entry>,
    pool: PgPool,
    /// Tells the notices of this process from those of others.
    own: Arc<str>,
    /// Notified when another process has made a key.
    keys: Arc<Notify>,
}

impl Notices {
    /// Begins to send.
    pub(super) fn new(pool: PgPool) -> Self {
        let (queue, notices) = unbounded_channel();
        let own: Arc<str> = uuid::Uuid::new_v4().simple().to_string().into();
        tokio::spawn(send(pool.clone(), Arc::clone(&own), notices));
        Self {
            queue,
            pool,
            own,
            keys: Arc::default(),
        }
    }

    /// Sends a notice soon.
    fn push(&self, notice: Notice) {
        // Fails only when the runtime ends.
        let _ = self.queue.send(Entry::Notice(notice));
    }

    /// Waits until all notices have been sent, and closes the connections. The last ones of a process
    /// are those of the jobs that it gives back: without them others would find these seconds later.
    pub(super) async fn close(&self) {
        let (sent, all_sent) = oneshot::channel();
        if self.queue.send(Entry::Flush(sent)).is_ok() {
            // A server that is away is not waited for.
            let _ = tokio::time::timeout(FLUSH, all_sent).await;
        }
        self.pool.close().await;
    }

    /// The notice of another process; `None` of an own one.
    fn foreign(&self, notification: &PgNotification) -> Option<Notice> {
        let (sender, text) = notification.payload().split_once(' ')?;
        (sender != &*self.own).then(|| Notice::of(text))
    }
}

async fn send(pool: PgPool, own: Arc<str>, mut entries: UnboundedReceiver<Entry>) {
    let mut waiting = Vec::new();
    while entries.recv_many(&mut waiting, BATCH).await > 0 {
        let (mut different, mut flushes) = (BTreeSet::new(), Vec::new());
        for entry in waiting.drain(..) {
            match entry {
                Entry::Notice(notice) => drop(different.insert(notice)),
                Entry::Flush(sent) => flushes.push(sent),
            }
        }
        if !different.is_empty() {
            notify(&pool, &own, &different).await;
        }
        for sent in flushes {
            // Who waited may have given up.
            let _ = sent.send(());
        }
    }
}

async fn notify(pool: &PgPool, own: &str, notices: &BTreeSet<Notice>) {
    let texts = notices.iter().map(|one| format!("{own} {}", one.text()));
    let sent = sqlx::query("SELECT pg_notify($1, text) FROM unnest($2) AS text")
        .bind(CHANNEL)
        .bind(texts.collect::<Vec<_>>())
        .execute(pool)
        .await;
    if let Err(error) = sent {
        tracing::warn!(%error, "other processes are not told of changes; they look for them");
    }
}

impl Store {
    /// Whether other services and workers may use the database.
    pub(crate) fn is_shared(&self) -> bool {
        matches!(self.database, Database::Postgres(_))
    }

    /// Tells other processes, soon and without a promise.
    pub(crate) fn tell(&self, notice: Notice) {
        if let Database::Postgres(PostgresDatabase { notices, .. }) = &self.database {
            notices.push(notice);
        }
    }

    /// Waits until another process has told that it made a key.
    pub(crate) async fn told_of_keys(&self) {
        match &self.database {
            Database::Postgres(database) => database.notices.keys.notified().await,
            Database::Sqlite(_) => std::future::pending().await,
        }
    }

    /// Calls `act` with the notices of other processes until the database is closed.
    pub(crate) async fn listen(&self, act: impl Fn(Notice)) {
        let Database::Postgres(PostgresDatabase { notices, .. }) = &self.database else {
            return;
        };
        while !notices.pool.is_closed() {
            match listen(notices, &act).await {
                Err(StoreError::Database(sqlx::Error::PoolClosed)) => return,
                Err(error) => {
                    tracing::warn!(%error, "notices of other processes cannot be received");
                }
                Ok(()) => {}
            }
            tokio::time::sleep(RETRY).await;
            act(Notice::Missed);
        }
    }
}

async fn listen(notices: &Notices, act: &impl Fn(Notice)) -> Result<(), StoreError> {
    let mut listener = PgListener::connect_with(&notices.pool).await?;
    listener.listen(CHANNEL).await?;
    notices.keys.notify_one();
    act(Notice::Missed);
    loop {
        let Some(notification) = listener.try_recv().await? else {
            // The connection was lost, and there is a new one.
            notices.keys.notify_one();
            act(Notice::Missed);
            continue;
        };
        let notice = notices.foreign(&notification);
        if notice == Some(Notice::Keys) {
            notices.keys.notify_one();
        }
        if let Some(notice) = notice {
            act(notice);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notices_are_read_as_they_were_written() {
        let id = "00000000-0000-7000-8000-000000000000";
        for notice in [
            Notice::Queued,
            Notice::Changed,
            Notice::Keys,
            Notice::Requested(id.into()),
        ] {
            assert_eq!(Notice::of(&notice.text()), notice);
        }
        assert_eq!(Notice::of("something new"), Notice::Changed);
    }
}
