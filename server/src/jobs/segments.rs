//! What the search of a job has solved, kept for another attempt at it.
//!
//! A job whose process is killed begins again. Its legs are known then, and so are the segments of
//! tours that its search has solved: the same questions in the same order, answered at once. They
//! are written many times a second, for what is not written is solved again, and some at a time, so
//! that others can write in between. They are read at once when an attempt begins (one by one, the
//! reading took a tenth of the time that it saved), and forgotten after the end of the job.

use crate::store::{JobRow, SegmentRow, Store, StoreError};
use slewplan_solver::model::motion::Motion;
use slewplan_solver::tour::legs::{SegmentStore, StoredSegment};
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::runtime::Handle;

/// Time before the first write, so that a search which is over soon writes nothing, and between two.
const FIRST: Duration = Duration::from_millis(250);
const ROUND: Duration = Duration::from_millis(40);
/// Segments that are written or forgotten together, and the pause for other writers after that.
const BATCH: usize = 32;
const FORGOTTEN: i64 = 256;
const PAUSE: Duration = Duration::from_millis(20);
/// Most bytes that are kept of a job: some minutes of processor time. What comes after that is
/// solved again.
const MAX_BYTES: usize = 128 << 20;

/// The segments of a lease, as the solver's threads see them.
#[derive(Debug)]
pub(super) struct SegmentCache {
    shared: Arc<Shared>,
    /// Whether an earlier attempt has left something.
    resumes: bool,
    /// What it has left, by name, until the solver asks for it: it remembers what it was given.
    left: Mutex<HashMap<String, SegmentRow>>,
}

#[derive(Debug)]
struct Shared {
    store: Store,
    lease: JobRow,
    unwritten: Mutex<Vec<SegmentRow>>,
    /// Bytes that were kept or shall be.
    bytes: AtomicUsize,
    wrote: AtomicBool,
}

impl Shared {
    fn unwritten(&self) -> MutexGuard<'_, Vec<SegmentRow>> {
        self.unwritten
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes what there is; `false` when the lease has been lost.
    async fn write(&self) -> Result<bool, StoreError> {
        let segments = std::mem::take(&mut *self.unwritten());
        for batch in segments.chunks(BATCH) {
            self.wrote.store(true, Ordering::Relaxed);
            if !self.store.put_segments(&self.lease, batch).await? {
                return Ok(false);
            }
            tokio::time::sleep(PAUSE).await;
        }
        Ok(true)
    }
}

impl SegmentCache {
    /// The segments of a lease, for threads outside of the runtime.
    pub(super) fn new(store: Store, runtime: &Handle, lease: JobRow) -> Self {
        let known = runtime.block_on(store.segments(lease.sequence));
        let known = known.unwrap_or_else(|error| {
            tracing::warn!(%error, "what an earlier attempt has solved cannot be looked up");
            Vec::new()
        });
        let bytes = known.iter().map(|row| row.motion.len()).sum();
        let by_name = known.into_iter().map(|row| (row.name.clone(), row));
        let left: HashMap<_, _> = by_name.collect();
        Self {
            shared: Arc::new(Shared {
                store,
                lease,
                unwritten: Mutex::default(),
                bytes: AtomicUsize::new(bytes),
                wrote: AtomicBool::new(false),
            }),
            resumes: !left.is_empty(),
            left: Mutex::new(left),
        }
    }

    /// Writes from time to time, until it is aborted or the lease is lost.
    pub(super) fn writing(&self) -> impl Future<Output = ()> + use<> {
        let shared = Arc::clone(&self.shared);
        async move {
            tokio::time::sleep(FIRST).await;
            loop {
                tokio::time::sleep(ROUND).await;
                match shared.write().await {
                    Ok(true) => {}
                    Ok(false) => return,
                    // What is forgotten is solved again: no reason to fail.
                    Err(error) => tracing::warn!(%error, "solved segments are forgotten"),
                }
            }
        }
    }

    /// Whether there may be something in the database that the end of the job leaves behind.
    pub(super) fn leaves_something(&self) -> bool {
        self.resumes || self.shared.wrote.load(Ordering::Relaxed)
    }
}

impl SegmentStore for SegmentCache {
    fn get(&self, name: &str) -> Option<StoredSegment> {
        let mut left = self.left.lock().unwrap_or_else(PoisonError::into_inner);
        let row = left.remove(name);
        drop(left);
        unpacked(&row?)
    }

    fn put(&self, name: &str, segment: StoredSegment) {
        let row = packed(name, &segment);
        let before = self
            .shared
            .bytes
            .fetch_add(row.motion.len(), Ordering::Relaxed);
        if before < MAX_BYTES {
            self.shared.unwritten().push(row);
        }
    }
}

/// Forgets what jobs that have ended leave behind.
pub(crate) async fn forget(store: Store) {
    loop {
        match store.forget_segments(FORGOTTEN).await {
            Ok(0) => return,
            Ok(_) => tokio::time::sleep(PAUSE).await,
            Err(error) => {
                tracing::warn!(%error, "segments of ended jobs cannot be forgotten yet");
                return;
            }
        }
    }
}

/// The number of wheels, attitudes, momenta, lengths and prices one after the other.
fn packed(name: &str, segment: &StoredSegment) -> SegmentRow {
    let attitudes = segment.motion.attitudes_xyzw.iter().flatten();
    let momenta = segment.motion.wheel_momenta_nms.iter().flatten();
    let prices = segment.costates_s_per_nms.iter().flatten();
    let numbers = attitudes.chain(momenta).chain(&segment.motion.lengths_s);
    let wheels = segment.motion.wheel_momenta_nms.first().map_or(0, Vec::len) as u64;
    let words = numbers.chain(prices).map(|number| number.to_bits());
    let words = std::iter::once(wheels).chain(words);
    SegmentRow {
        name: name.to_owned(),
        intervals: i64::try_from(segment.motion.lengths_s.len()).unwrap_or(i64::MAX),
        motion: words.flat_map(u64::to_le_bytes).collect(),
    }
}

/// The segment of packed numbers; `None` when they are not as many as there must be.
fn unpacked(row: &SegmentRow) -> Option<StoredSegment> {
    let (words, []) = row.motion.as_chunks::<8>() else {
        return None;
    };
    let (wheels, words) = words.split_first()?;
    let wheels = usize::try_from(u64::from_le_bytes(*wheels)).ok()?;
    let numbers: Vec<f64> = words.iter().map(|word| f64::from_le_bytes(*word)).collect();
    let intervals = usize::try_from(row.intervals).ok()?;
    let nodes = intervals.checked_add(1)?;
    let (attitudes, rest) = numbers.split_at_checked(nodes.checked_mul(4)?)?;
    let (momenta, rest) = rest.split_at_checked(nodes.checked_mul(wheels)?)?;
    let (lengths, prices) = rest.split_at_checked(intervals)?;
    if intervals == 0 || wheels == 0 || prices.len() % wheels != 0 {
        return None;
    }
    let by_wheels = |numbers: &[f64]| numbers.chunks(wheels).map(<[f64]>::to_vec).collect();
    Some(StoredSegment {
        motion: Motion {
            attitudes_xyzw: attitudes.as_chunks().0.to_vec(),
            wheel_momenta_nms: by_wheels(momenta),
            lengths_s: lengths.to_vec(),
        },
        costates_s_per_nms: by_wheels(prices),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment() -> StoredSegment {
        StoredSegment {
            motion: Motion {
                attitudes_xyzw: vec![[0.1, 0.2, -0.3, 1.0 / 3.0]; 3],
                wheel_momenta_nms: vec![
                    vec![1e-300, -2.5],
                    vec![0.1, 7.0],
                    vec![-0.0, f64::MIN_POSITIVE],
                ],
                lengths_s: vec![1.5, 0.1 + 0.2],
            },
            costates_s_per_nms: vec![vec![-90.0, 1.0 / 7.0]],
        }
    }

    #[test]
    fn a_motion_comes_back_bit_for_bit() {
        assert_eq!(unpacked(&packed("piece 1 2", &segment())), Some(segment()));
    }

    #[test]
    fn numbers_that_do_not_fit_together_are_no_motion() {
        let good = packed("piece 1 2", &segment());
        for intervals in [-1, 0, 1, 3, i64::MAX] {
            let row = SegmentRow {
                intervals,
                ..good.clone()
            };
            assert_eq!(unpacked(&row), None, "{intervals}");
        }
        for length in [0, 7, 8, good.motion.len() - 8] {
            let motion = good.motion[..length].to_vec();
            let row = SegmentRow {
                motion,
                ..good.clone()
            };
            assert_eq!(unpacked(&row), None, "{length}");
        }
    }
}
