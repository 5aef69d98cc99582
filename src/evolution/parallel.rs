//! Independent pieces of work, spread over threads.

use std::sync::{Mutex, PoisonError};

use rayon::iter::{ParallelBridge, ParallelIterator};
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

use super::turns::{PooledTask, TaskPool};

/// Threads for the pieces of a run's work.
///
/// Results never depend on the number of threads: a piece draws from random streams
/// of its own, and results are put in order before anybody sees them.
#[derive(Debug)]
pub struct Workers {
    pool: ThreadPool,
}

impl Workers {
    /// Starts `threads` threads; 0 means one for each processor.
    ///
    /// # Errors
    /// When the operating system gives no threads.
    pub fn new(threads: usize) -> Result<Self, ThreadPoolBuildError> {
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|index| format!("worker-{index}"))
            .build()?;
        Ok(Self { pool })
    }

    /// Number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Brings all tasks to their ends and returns them in their order.
    ///
    /// Turn by turn every thread takes the task that has most left to do, so that all
    /// come to their ends together and no thread waits for a long last one. A single
    /// thread waits for nobody: it does one task after the other, which is kinder to caches.
    ///
    /// # Errors
    /// With the error of a turn, if one fails; the other tasks are given up.
    pub(crate) fn finish<T: PooledTask>(&self, tasks: Vec<T>) -> Result<Vec<T>, T::Error> {
        let pool = Mutex::new(TaskPool::new(tasks));
        let lock = || pool.lock().unwrap_or_else(PoisonError::into_inner);
        let alone = self.threads() == 1;
        self.pool.broadcast(|_| {
            let mut held = lock().take();
            while let Some(mut numbered) = held {
                let turn = numbered.task.turn();
                let kept = alone && turn.is_ok() && numbered.task.left().is_some();
                held = match kept {
                    true => Some(numbered),
                    false => lock().exchange(numbered, turn),
                };
            }
        });
        let pool = pool.into_inner().unwrap_or_else(PoisonError::into_inner);
        pool.into_finished()
    }

    /// Does every piece of `order`, started in that order, and returns the results
    /// sorted by piece. Starting the longest pieces first leaves the threads little
    /// to wait for at the end.
    ///
    /// # Errors
    /// With the error of a piece, if one fails.
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
    fn results_come_in_the_order_of_the_pieces() {
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
