//! Reads from the lines of test runners how many tests passed and failed.

use std::ops::AddAssign;

/// Tests of one or more runs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Tests that passed.
    pub passed: u64,
    /// Tests that failed, or could not run.
    pub failed: u64,
    /// Tests that were switched off.
    pub skipped: u64,
}

impl From<()> for Counts {
    /// No test of its own.
    fn from((): ()) -> Self {
        Self::default()
    }
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.skipped += other.skipped;
    }
}

/// Sum of the `test result:` lines that `cargo test` printed. A test that lacks a program of the system says so in a
/// line that begins with `skipped:`, and ends as if it had passed.
pub fn of_cargo(lines: &[String]) -> Counts {
    let mut sum = Counts::default();
    for line in lines {
        if line.starts_with("skipped: ") {
            sum.skipped += 1;
            sum.passed = sum.passed.wrapping_sub(1);
        }
        if let Some((_, counts)) = line.strip_prefix("test result: ").and_then(|rest| rest.split_once(". ")) {
            sum += of_parts(counts.split("; "));
        }
    }
    sum
}

/// The last summary line that pytest printed, with or without its frame of equals signs.
pub fn of_pytest(lines: &[String]) -> Counts {
    let summaries = lines.iter().rev().filter_map(|line| line.trim_matches(['=', ' ']).rsplit_once(" in "));
    let counted = summaries.map(|(counts, _)| of_parts(counts.split(", ")));
    counted.into_iter().find(|&counts| counts != Counts::default()).unwrap_or_default()
}

/// Sums parts such as `12 passed`.
fn of_parts<'a>(parts: impl Iterator<Item = &'a str>) -> Counts {
    let mut sum = Counts::default();
    for part in parts {
        let Some((number, word)) = part.trim().split_once(' ') else { continue };
        let Ok(number) = number.parse::<u64>() else { continue };
        match word {
            "passed" | "xpassed" => sum.passed += number,
            "failed" | "error" | "errors" => sum.failed += number,
            "ignored" | "skipped" | "xfailed" | "deselected" => sum.skipped += number,
            _ => {}
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<String> {
        text.lines().map(str::to_owned).collect()
    }

    #[test]
    fn cargo_results_are_summed() {
        let text = "running 2 tests\n\
            test result: ok. 2 passed; 0 failed; 0 ignored; 0 measured; 7 filtered out; finished in 0.01s\n\
            test result: FAILED. 3 passed; 1 failed; 4 ignored; 0 measured; 0 filtered out; finished in 0.01s\n";
        assert_eq!(of_cargo(&lines(text)), Counts { passed: 5, failed: 1, skipped: 4 });
        assert_eq!(of_cargo(&lines("no tests here: 5 passed; 0 failed")), Counts::default());
    }

    #[test]
    fn pytest_summary_is_read_in_both_shapes() {
        let framed = lines("collected 4 items in 2 files\n==== 1 failed, 2 passed, 1 error in 0.12s ====");
        assert_eq!(of_pytest(&framed), Counts { passed: 2, failed: 2, skipped: 0 });
        let bare = lines("..s\n2 passed, 1 skipped in 0.02s\n");
        assert_eq!(of_pytest(&bare), Counts { passed: 2, failed: 0, skipped: 1 });
        assert_eq!(of_pytest(&lines("==== no tests ran in 0.00s ====")), Counts::default());
    }
}
