//! A scheduler that always advances the task with the most work left, so that all threads
//! finish at about the same time.

/// Work that is done in turns.
pub(crate) trait PooledTask: Send {
    /// The error of a turn.
    type Error: Send;

    /// Estimates the work left, in a unit that all tasks share. Returns `None` when the task is
    /// finished.
    fn left(&self) -> Option<f64>;

    /// Runs one turn.
    fn turn(&mut self) -> Result<(), Self::Error>;
}

/// A task and its place in the order of all tasks.
pub(super) struct Numbered<T> {
    number: usize,
    pub(super) task: T,
}

/// The tasks of several threads, which return one after each turn and take the next.
pub(super) struct TaskPool<T: PooledTask> {
    waiting: Vec<Numbered<T>>,
    finished: Vec<Numbered<T>>,
    failed: Option<T::Error>,
}

impl<T: PooledTask> TaskPool<T> {
    pub(super) fn new(tasks: Vec<T>) -> Self {
        let numbered = tasks.into_iter().enumerate();
        let mut pool = Self {
            waiting: Vec::new(),
            finished: Vec::new(),
            failed: None,
        };
        for (number, task) in numbered {
            pool.put(Numbered { number, task });
        }
        pool
    }

    /// Takes the task with the most work left. A thread that gets `None` is done: all
    /// unfinished tasks are held by other threads.
    pub(super) fn take(&mut self) -> Option<Numbered<T>> {
        if self.failed.is_some() {
            return None;
        }
        let left = |numbered: &Numbered<T>| numbered.task.left().unwrap_or(0.0);
        let lefts = self.waiting.iter().map(left).enumerate();
        let most = lefts.max_by(|(_, a), (_, b)| a.total_cmp(b));
        most.map(|(index, _)| self.waiting.swap_remove(index))
    }

    /// Puts a task back after its turn and takes the next.
    pub(super) fn exchange(
        &mut self,
        back: Numbered<T>,
        turn: Result<(), T::Error>,
    ) -> Option<Numbered<T>> {
        match turn {
            Ok(()) => self.put(back),
            Err(error) => self.failed = Some(error),
        }
        self.take()
    }

    /// Returns all tasks in their order. Call it when all threads are done.
    pub(super) fn into_finished(mut self) -> Result<Vec<T>, T::Error> {
        if let Some(error) = self.failed {
            return Err(error);
        }
        self.finished
            .sort_unstable_by_key(|numbered| numbered.number);
        let tasks = self.finished.into_iter();
        Ok(tasks.map(|numbered| numbered.task).collect())
    }

    fn put(&mut self, numbered: Numbered<T>) {
        match numbered.task.left() {
            Some(_) => self.waiting.push(numbered),
            None => self.finished.push(numbered),
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::super::parallel::Workers;
    use super::*;
    use crate::random::{Purpose, stream};

    /// A task that counts down and fails at a given number.
    #[derive(Debug, PartialEq)]
    struct Countdown {
        left: u32,
        turns: u32,
        fails_at: Option<u32>,
    }

    impl PooledTask for Countdown {
        type Error = u32;

        fn left(&self) -> Option<f64> {
            (self.left > 0).then_some(f64::from(self.left))
        }

        fn turn(&mut self) -> Result<(), u32> {
            if self.fails_at == Some(self.left) {
                return Err(self.left);
            }
            self.left -= 1;
            self.turns += 1;
            Ok(())
        }
    }

    fn countdown(left: u32) -> Countdown {
        Countdown {
            left,
            turns: 0,
            fails_at: None,
        }
    }

    #[test]
    fn tasks_are_finished_and_returned_in_their_order() {
        for threads in [1, 2, 5] {
            let workers = Workers::new(threads).unwrap();
            let tasks = (1..40).map(|n| countdown(n % 7 + 1)).collect();
            let done = workers.finish(tasks).unwrap();
            let turns: Vec<_> = done.iter().map(|task| task.turns).collect();
            assert_eq!(turns, (1..40).map(|n| n % 7 + 1).collect::<Vec<_>>());
            assert!(done.iter().all(|task| task.left == 0));
        }
    }

    #[test]
    fn a_task_that_fails_ends_the_work() {
        for threads in [1, 2] {
            let workers = Workers::new(threads).unwrap();
            let failing = Countdown {
                fails_at: Some(3),
                ..countdown(5)
            };
            let tasks = vec![countdown(4), failing, countdown(6)];
            assert_eq!(workers.finish(tasks), Err(3));
        }
    }

    #[test]
    fn the_task_with_the_most_work_left_is_next() {
        let mut pool = TaskPool::new(vec![countdown(3), countdown(9), countdown(5)]);
        let mut longest = pool.take().unwrap();
        assert_eq!(longest.task.left, 9);
        longest.task.left = 4;
        let next = pool.exchange(longest, Ok(())).unwrap();
        assert_eq!(next.task.left, 5);
    }

    /// Trials whose lengths are not known in advance.
    struct Trials {
        lengths: Vec<f64>,
        over: usize,
    }

    impl PooledTask for Trials {
        type Error = ();

        fn left(&self) -> Option<f64> {
            let done: f64 = self.lengths[..self.over].iter().sum();
            let mean = (done + 2000.0) / (self.over + 1) as f64;
            let to_come = self.lengths.len() - self.over;
            (to_come > 0).then_some(to_come as f64 * mean)
        }

        fn turn(&mut self) -> Result<(), ()> {
            self.over += 1;
            Ok(())
        }
    }

    /// Simulated threads with their own clocks, so that the load of the machine has no effect.
    #[test]
    fn two_threads_finish_at_about_the_same_time() {
        let mut rng = stream(1, 0, 0, Purpose::Trials);
        let (mut work, mut wall) = (0.0, 0.0);
        for _ in 0..30 {
            // Mean lengths differ up to threefold; lengths vary at random around them.
            let tasks: Vec<_> = (0..16)
                .map(|number| {
                    let mean = 100.0 * 3_f64.powf(rng.random());
                    let trials = if number < 2 { 8 } else { 16 };
                    let lengths = (0..trials).map(|_| -mean * f64::ln(1.0 - rng.random::<f64>()));
                    Trials {
                        lengths: lengths.collect(),
                        over: 0,
                    }
                })
                .collect();
            work += tasks.iter().flat_map(|task| &task.lengths).sum::<f64>();
            let mut pool = TaskPool::new(tasks);
            let mut threads = [0.0, 0.0].map(|clock| (clock, pool.take()));
            while threads.iter().any(|(_, held)| held.is_some()) {
                let busy = threads.iter_mut().filter(|(_, held)| held.is_some());
                // The thread whose turn ends first returns to the pool first.
                let turn = |held: &Option<Numbered<Trials>>| {
                    let task = &held.as_ref().unwrap().task;
                    task.lengths[task.over]
                };
                let (clock, held) = busy
                    .min_by(|(a, held_a), (b, held_b)| {
                        (a + turn(held_a)).total_cmp(&(b + turn(held_b)))
                    })
                    .unwrap();
                *clock += turn(held);
                let mut back = held.take().unwrap();
                back.task.turn().unwrap();
                *held = pool.exchange(back, Ok(()));
            }
            wall += f64::max(threads[0].0, threads[1].0);
        }
        assert!(work / wall > 1.97, "{}", work / wall);
    }
}
