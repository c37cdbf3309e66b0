//! Segments of tours that the search of a job has solved, stored for further attempts.
//!
//! A job whose process is killed begins again and needs the same segments in the same order. They
//! are written many times a second, because unwritten ones are solved again, and in small batches,
//! so that other writes come in between. They are all read when an attempt begins, and deleted
//! after the end of the job.

use crate::store::{JobRow, SegmentRow, Store, StoreError};
use slewplan_solver::model::motion::Motion;
use slewplan_solver::tour::legs::{SegmentStore, StoredSegment};
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::runtime::Handle;

/// Time before the first write, so that short searches write nothing, and between two writes.
const FIRST: Duration = Duration::from_millis(250);
const ROUND: Duration = Duration::from_millis(40);
/// Segments written or deleted per transaction, and the pause for other writers after it.
const BATCH: usize = 32;
const DELETED_BATCH: i64 = 256;
const PAUSE: Duration = Duration::from_millis(20);
/// Maximum size of the stored segments of a job, bytes: a few minutes of processor time. Segments
/// beyond it are solved again by another attempt.
const MAX_BYTES: usize = 128 << 20;

/// The solver's view of the segments of a leased job.
#[derive(Debug)]
pub(super) struct SegmentCache {
    shared: Arc<SharedSegments>,
    /// Whether an earlier attempt has stored segments.
    resumes: bool,
    /// Stored segments by name, each removed when the solver asks for it, which keeps it from then
    /// on.
    left: Mutex<HashMap<String, SegmentRow>>,
}

#[derive(Debug)]
struct SharedSegments {
    store: Store,
    lease: JobRow,
    unwritten: Mutex<Vec<SegmentRow>>,
    /// Bytes of all segments, stored or to be stored.
    bytes: AtomicUsize,
    wrote: AtomicBool,
}

impl SharedSegments {
    fn unwritten(&self) -> MutexGuard<'_, Vec<SegmentRow>> {
        self.unwritten
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// Stores the unwritten segments; `false` when the lease has been lost.
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
        let known = if lease.fence > 1 {
            runtime.block_on(store.segments(lease.sequence))
        } else {
            // Nobody has worked on it before.
            Ok(Vec::new())
        };
        let known = known.unwrap_or_else(|error| {
            tracing::warn!(%error, "segments of earlier attempts cannot be read");
            Vec::new()
        });
        let bytes = known.iter().map(|row| row.motion.len()).sum();
        let by_name = known.into_iter().map(|row| (row.name.clone(), row));
        let left: HashMap<_, _> = by_name.collect();
        Self {
            shared: Arc::new(SharedSegments {
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

    /// Stores new segments at intervals, until it is aborted or the lease is lost.
    pub(super) fn writing(&self) -> impl Future<Output = ()> + use<> {
        let shared = Arc::clone(&self.shared);
        async move {
            tokio::time::sleep(FIRST).await;
            loop {
                tokio::time::sleep(ROUND).await;
                match shared.write().await {
                    Ok(true) => {}
                    Ok(false) => return,
                    // Not an error of the job: lost segments are solved again.
                    Err(error) => tracing::warn!(%error, "solved segments cannot be stored"),
                }
            }
        }
    }

    /// Whether there may be segments in the database to be deleted after the end of the job.
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

/// Deletes the segments of ended jobs.
pub(crate) async fn delete_of_ended_jobs(store: Store) {
    loop {
        match store.delete_segments_of_ended_jobs(DELETED_BATCH).await {
            Ok(0) => return,
            Ok(_) => tokio::time::sleep(PAUSE).await,
            Err(error) => {
                tracing::warn!(%error, "segments of ended jobs cannot be deleted yet");
                return;
            }
        }
    }
}

/// The number of wheels, then attitudes, momenta, lengths and costates, as little-endian words.
fn packed(name: &str, segment: &StoredSegment) -> SegmentRow {
    let attitudes = segment.motion.attitudes_xyzw.iter().flatten();
    let momenta = segment.motion.wheel_momenta_nms.iter().flatten();
    let costates = segment.costates_s_per_nms.iter().flatten();
    let numbers = attitudes.chain(momenta).chain(&segment.motion.lengths_s);
    let wheels = segment.motion.wheel_momenta_nms.first().map_or(0, Vec::len) as u64;
    let words = numbers.chain(costates).map(|number| number.to_bits());
    let words = std::iter::once(wheels).chain(words);
    SegmentRow {
        name: name.to_owned(),
        intervals: i64::try_from(segment.motion.lengths_s.len()).unwrap_or(i64::MAX),
        motion: words.flat_map(u64::to_le_bytes).collect(),
    }
}

/// The segment of a row; `None` when the count of its numbers is wrong.
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
    let (lengths, costates) = rest.split_at_checked(intervals)?;
    if intervals == 0 || wheels == 0 || costates.len() % wheels != 0 {
        return None;
    }
    let by_wheels = |numbers: &[f64]| numbers.chunks(wheels).map(<[f64]>::to_vec).collect();
    Some(StoredSegment {
        motion: Motion {
            attitudes_xyzw: attitudes.as_chunks().0.to_vec(),
            wheel_momenta_nms: by_wheels(momenta),
            lengths_s: lengths.to_vec(),
        },
        costates_s_per_nms: by_wheels(costates),
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
    fn packing_and_unpacking_keep_every_bit() {
        assert_eq!(unpacked(&packed("piece 1 2", &segment())), Some(segment()));
    }

    #[test]
    fn rows_with_a_wrong_count_of_numbers_are_refused() {
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
