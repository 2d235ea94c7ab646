//! Steps of a test command, one after another, and their counts of tests.

use std::process::ExitCode;
use std::time::Instant;

use crate::counts::Counts;

/// Verdict of a trial that found nothing bad.
pub enum Verdict {
    /// All is good; the observation.
    Good(String),
    /// It cannot be made here, and why.
    LeftOut(String),
}

/// Makes a trial and prints its verdict, with a word for what is good and one for what is bad; whether it is good, none
/// where it was left out.
pub fn attempt([good, bad]: [&str; 2], name: &str, act: impl FnOnce() -> Result<Verdict, String>) -> Option<bool> {
    let start = Instant::now();
    let verdict = act();
    let seconds = start.elapsed().as_secs_f64();
    let (word, told, found) = match verdict {
        Ok(Verdict::Good(seen)) => (good, seen, Some(true)),
        Ok(Verdict::LeftOut(why)) => ("left out", why, None),
        Err(why) => (bad, why, Some(false)),
    };
    println!("{word:<8} {seconds:>6.1} s  {name}: {told}");
    found
}

/// Steps that have run.
#[derive(Default)]
pub struct Steps {
    counts: Counts,
    failed: Vec<String>,
}

impl Steps {
    /// Runs one step under a header; whether it is good.
    pub fn take<C: Into<Counts>>(&mut self, name: &str, act: impl FnOnce() -> Result<C, String>) -> bool {
        println!("\n== {name}");
        let start = Instant::now();
        let verdict = self.judge(name, act().map(C::into));
        let seconds = start.elapsed().as_secs_f64();
        match &verdict {
            Ok(()) => println!("-- {name}: ok, {seconds:.1} s"),
            Err(problem) => println!("-- {name}: FAILED, {seconds:.1} s: {problem}"),
        }
        verdict.is_ok()
    }

    /// Counts the tests of a step; one that is bad without a failed test counts as one failure.
    fn judge(&mut self, name: &str, result: Result<Counts, String>) -> Result<(), String> {
        let (counts, problem) = match result {
            Ok(counts) if counts.failed == 0 => (counts, None),
            Ok(counts) => (counts, Some(format!("{} failed", counts.failed))),
            Err(problem) => (Counts::default(), Some(problem)),
        };
        self.counts += counts;
        let Some(problem) = problem else { return Ok(()) };
        if counts.failed == 0 {
            self.counts.failed += 1;
        }
        self.failed.push(name.to_owned());
        Err(problem)
    }

    /// Prints how many tests passed, failed and were skipped so far.
    pub fn print_counts(&self) {
        let Counts { passed, failed, skipped } = self.counts;
        println!("{passed} passed, {failed} failed, {skipped} skipped");
    }

    /// Prints the steps that failed and, last of all, the closing line.
    pub fn close(self) -> ExitCode {
        let Counts { passed, failed, .. } = self.counts;
        println!();
        if passed + failed == 0 {
            println!("no test ran");
        } else if failed > 0 {
            println!("failed: {}", self.failed.join(", "));
        }
        self.print_counts();
        if passed > 0 && failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(results: &[Result<Counts, String>]) -> Steps {
        let mut steps = Steps::default();
        for result in results {
            let _ = steps.judge("step", result.clone());
        }
        steps
    }

    fn counts(passed: u64, failed: u64, skipped: u64) -> Counts {
        Counts { passed, failed, skipped }
    }

    #[test]
    fn good_steps_close_well() {
        let steps = steps(&[Ok(Counts::default()), Ok(counts(3, 0, 0)), Ok(counts(2, 0, 0))]);
        assert_eq!(steps.counts, counts(5, 0, 0));
        assert!(steps.close() == ExitCode::SUCCESS);
    }

    #[test]
    fn a_bad_step_never_stands_beside_zero_failed() {
        let broken = steps(&[Err("lint".to_owned()), Ok(counts(3, 0, 0))]);
        assert_eq!(broken.counts, counts(3, 1, 0));
        assert!(broken.close() == ExitCode::FAILURE);
        let failing = steps(&[Ok(counts(3, 2, 1))]);
        assert_eq!(failing.counts.failed, 2);
        assert!(failing.close() == ExitCode::FAILURE);
    }

    #[test]
    fn skipped_tests_neither_pass_nor_fail() {
        let skipping = steps(&[Ok(counts(3, 0, 1))]);
        assert_eq!(skipping.counts, counts(3, 0, 1));
        assert!(skipping.close() == ExitCode::SUCCESS);
        assert!(steps(&[Ok(counts(0, 0, 1))]).close() == ExitCode::FAILURE);
    }

    #[test]
    fn no_test_at_all_is_a_failure() {
        assert!(steps(&[Ok(Counts::default())]).close() == ExitCode::FAILURE);
    }
}
