//! The leg cache of a database for one command.

use super::failure::Failure;
use super::runtime;
use crate::documents;
use crate::jobs::leg_cache::LegCache;
use crate::service::ServiceError;
use crate::store::{DatabaseAddress, Store};
use slewplan_solver::tour::legs::LegStore;
use std::sync::Arc;
use tokio::runtime::Runtime;

/// The leg cache; new legs are stored at the latest when it is dropped.
pub(super) struct CommandLegCache {
    // Dropped before the runtime, which it needs to store legs.
    legs: LegCache,
    _runtime: Runtime,
}

impl CommandLegCache {
    /// Opens or creates a database.
    pub(super) fn open(database: &DatabaseAddress) -> Result<Self, Failure> {
        let runtime = runtime::start()?;
        let store = runtime
            .block_on(Store::open(database, documents::jobs::tell))
            .map_err(ServiceError::from)?;
        let legs = LegCache::new(store, runtime.handle().clone(), Arc::default());
        Ok(Self {
            legs,
            _runtime: runtime,
        })
    }

    /// The cached legs.
    pub(super) fn legs(&self) -> &dyn LegStore {
        &self.legs
    }
}
