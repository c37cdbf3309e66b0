//! Notices between processes.

use super::{on_an_address, open};
use crate::store::Notice;
use std::time::Duration;
use tokio::sync::mpsc::unbounded_channel;

const ROUNDS: usize = 20;

#[test]
fn the_last_notices_of_a_process_are_heard() {
    on_an_address(async |address| {
        let listening = open(&address).await;
        if !listening.is_shared() {
            return;
        }
        let (told, mut heard) = unbounded_channel();
        let store = listening.clone();
        tokio::spawn(async move { store.listen(move |notice| drop(told.send(notice))).await });
        assert_eq!(heard.recv().await, Some(Notice::Missed), "it listens");
        for round in 0..ROUNDS {
            let ending = open(&address).await;
            let notice = Notice::Requested(round.to_string());
            ending.tell(notice.clone());
            ending.close().await;
            let next = tokio::time::timeout(Duration::from_mins(1), heard.recv()).await;
            assert_eq!(next, Ok(Some(notice)));
        }
    });
}
