//! Tasks that are done in turns, so that threads come to the end together.

/// Work that is done in turns.
pub(crate) trait Task: Send {
    /// Why a turn can fail.
    type Error: Send;

    /// An estimate of the work that is left, in a unit that all tasks share; `None` at
    /// the end.
    fn left(&self) -> Option<f64>;

    /// Does one turn.
    fn turn(&mut self) -> Result<(), Self::Error>;
}

/// A task and its place among all.
pub(super) struct Numbered<T> {
    number: usize,
    pub(super) task: T,
}

/// Where threads leave a task after a turn and take the next.
pub(super) struct Desk<T: Task> {
    waiting: Vec<Numbered<T>>,
    finished: Vec<Numbered<T>>,
    failed: Option<T::Error>,
}

impl<T: Task> Desk<T> {
    pub(super) fn new(tasks: Vec<T>) -> Self {
        let numbered = tasks.into_iter().enumerate();
        let mut desk = Self {
            waiting: Vec::new(),
            finished: Vec::new(),
            failed: None,
        };
        for (number, task) in numbered {
            desk.put(Numbered { number, task });
        }
        desk
    }

    /// The task with most left. A thread that finds none may go: the tasks that are not
    /// here are in the hands of the other threads.
    pub(super) fn take(&mut self) -> Option<Numbered<T>> {
        if self.failed.is_some() {
            return None;
        }
        let left = |numbered: &Numbered<T>| numbered.task.left().unwrap_or(0.0);
        let lefts = self.waiting.iter().map(left).enumerate();
        let most = lefts.max_by(|(_, a), (_, b)| a.total_cmp(b));
        most.map(|(index, _)| self.waiting.swap_remove(index))
    }

    /// Takes a task back after its turn, and gives the next.
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

    /// All tasks in their order, when all threads have gone.
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
    use super::super::parallel::Workers;
    use super::*;

    /// Counts down; fails at a number.
    #[derive(Debug, PartialEq)]
    struct Countdown {
        left: u32,
        turns: u32,
        fails_at: Option<u32>,
    }

    impl Task for Countdown {
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
    fn tasks_are_finished_and_come_back_in_their_order() {
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
    fn the_task_with_most_left_is_next() {
        let mut desk = Desk::new(vec![countdown(3), countdown(9), countdown(5)]);
        let mut longest = desk.take().unwrap();
        assert_eq!(longest.task.left, 9);
        longest.task.left = 4;
        let next = desk.exchange(longest, Ok(())).unwrap();
        assert_eq!(next.task.left, 5);
    }
}
