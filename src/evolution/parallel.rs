//! Threads for independent pieces of work.

use std::num::NonZeroUsize;
use std::sync::{Mutex, PoisonError};
use std::{env, thread};

use rayon::iter::{ParallelBridge, ParallelIterator};
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

use super::turns::{PooledTask, TaskPool};

/// The threads of a run.
///
/// Results do not depend on the number of threads: each piece of work draws from its own
/// random streams, and results are returned in the order of the pieces.
#[derive(Debug)]
pub struct Workers {
    pool: ThreadPool,
}

/// Returns the number of processors that this process may use: those that Slurm has given to the
/// task, or else those that the operating system allows.
#[must_use]
pub fn processors() -> NonZeroUsize {
    let allowed = thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let given = env::var("SLURM_CPUS_PER_TASK").ok();
    let given = given.and_then(|text| text.parse().ok());
    given.map_or(allowed, |given: NonZeroUsize| given.min(allowed))
}

impl Workers {
    /// Starts `threads` threads, or one for each of the [`processors`] if that is 0.
    ///
    /// # Errors
    /// When the operating system refuses to start threads.
    pub fn new(threads: usize) -> Result<Self, ThreadPoolBuildError> {
        let pool = ThreadPoolBuilder::new()
            .num_threads(NonZeroUsize::new(threads).unwrap_or_else(processors).get())
            .thread_name(|index| format!("worker-{index}"))
            .build()?;
        Ok(Self { pool })
    }

    /// Returns the number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Finishes all tasks and returns them in their order.
    ///
    /// In every turn a thread takes the task with the most work left, so that all threads
    /// finish at about the same time. A single thread runs one task after the other, which
    /// is better for caches.
    ///
    /// # Errors
    /// With the error of the first turn that fails. The other tasks are abandoned.
    pub(crate) fn finish<T: PooledTask>(&self, tasks: Vec<T>) -> Result<Vec<T>, T::Error> {
        let pool = Mutex::new(TaskPool::new(tasks));
        let lock = || pool.lock().unwrap_or_else(PoisonError::into_inner);
        let alone = self.threads() == 1;
        self.pool.broadcast(|_| {
            let mut held = lock().take();
            while let Some(mut numbered) = held {
                let turn = numbered.task.turn();
                let kept = alone && turn.is_ok() && numbered.task.left().is_some();
                held = if kept {
                    Some(numbered)
                } else {
                    lock().exchange(numbered, turn)
                };
            }
        });
        let pool = pool.into_inner().unwrap_or_else(PoisonError::into_inner);
        pool.into_finished()
    }

    /// Computes every piece of `order`, started in that order, and returns the results sorted
    /// by piece. Start the longest pieces first to keep the threads busy until the end.
    ///
    /// # Errors
    /// With the error of a piece that fails.
    pub fn map<T: Send, E: Send>(
        &self,
        order: Vec<usize>,
        work: impl Fn(usize) -> Result<T, E> + Sync,
    ) -> Result<Vec<T>, E> {
        let pieces = order.into_iter().par_bridge();
        let done = pieces.map(|piece| work(piece).map(|result| (piece, result)));
        let mut results: Vec<_> = self.pool.install(|| done.collect::<Result<_, E>>())?;
        results.sort_unstable_by_key(|(piece, _)| *piece);
        Ok(results.into_iter().map(|(_, result)| result).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_sorted_by_piece() {
        let workers = Workers::new(3).unwrap();
        let order: Vec<usize> = (0..50).rev().collect();
        let squares: Result<Vec<_>, ()> = workers.map(order, |piece| Ok(piece * piece));
        assert_eq!(squares.unwrap(), (0..50).map(|i| i * i).collect::<Vec<_>>());
        let failed = workers.map(
            vec![1, 2, 3],
            |piece| if piece == 2 { Err(piece) } else { Ok(()) },
        );
        assert_eq!(failed, Err(2));
    }
}
