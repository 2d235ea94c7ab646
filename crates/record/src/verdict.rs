//! What a run says of its slope in one line.

use enmm_io::numbers::three_digits;

use crate::summary::{RunStatus, StageRecord};

/// Whether the slope has failed, in one line.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Whether it has failed in any stage.
    pub failed: bool,
    /// The line.
    pub text: String,
}

impl Verdict {
    /// The verdict on stages that have begun, of a run that ended in this way.
    pub fn of(stages: &[StageRecord], status: RunStatus) -> Self {
        let failed = |stage: &StageRecord| {
            let goes_on = if stage.ended_early { ", still moving when the stage was ended" } else { "" };
            Some(format!("in stage {} {}{goes_on}", stage.name, stage.failure.as_ref()?.text))
        };
        let failures: Vec<String> = stages.iter().filter_map(failed).collect();
        let text = if failures.is_empty() { unfailed(stages, status) } else { failing(&failures) };
        Self { failed: !failures.is_empty(), text }
    }
}

fn failing(failures: &[String]) -> String {
    format!("the slope failed {}", failures.join("; "))
}

fn unfailed(stages: &[StageRecord], status: RunStatus) -> String {
    let far = |stage: &StageRecord| {
        let displacement = three_digits(stage.displacement).unwrap_or_else(|small| format!("{small:.2e}"));
        format!("largest displacement {displacement} m")
    };
    let restless = stages.iter().find(|stage| stage.converged == Some(false));
    let farthest = stages
        .iter()
        .filter(|stage| stage.displacement.is_finite())
        .max_by(|a, b| a.displacement.total_cmp(&b.displacement));
    match (status, restless, farthest) {
        (RunStatus::Interrupted, ..) => "no verdict yet: the run was interrupted".to_owned(),
        (RunStatus::Failed, ..) => "no verdict: the run failed numerically".to_owned(),
        (_, Some(stage), _) => format!("no verdict: stage {} did not come to rest, {}", stage.name, far(stage)),
        (_, None, Some(stage)) => format!("the slope has not failed: {} in stage {}", far(stage), stage.name),
        (_, None, None) => "no verdict: no stage has begun".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::FailureOfStage;
    use enmm::model::case::StageKind;

    fn stage(name: &str, kind: StageKind, converged: Option<bool>, failure: Option<&str>) -> StageRecord {
        let failure = failure.map(|text| FailureOfStage {
            mechanism: "toppling".to_owned(),
            blocks: 56,
            mass: 1e6,
            displacement: 10.3,
            block: 17,
            place: [1.0, 2.0],
            text: text.to_owned(),
        });
        StageRecord {
            name: name.to_owned(),
            kind,
            start: 0.0,
            time: 1.0,
            steps: 10,
            converged,
            ended_early: false,
            displacement: 0.0321,
            failure,
            wall_seconds: None,
            unbalanced: 0.0,
            kinetic_energy: 0.0,
            potential_released: 0.0,
            unsettled: 0,
            penetration_max: 0.0,
        }
    }

    #[test]
    fn a_failure_is_named_with_its_stage_whatever_comes_later() {
        let stages = [
            stage("gravity", StageKind::Static, Some(false), Some("by toppling: 56 blocks")),
            stage("quake", StageKind::Dynamic, None, None),
        ];
        let verdict = Verdict::of(&stages, RunStatus::Finished);
        assert_eq!(verdict.text, "the slope failed in stage gravity by toppling: 56 blocks");
        assert!(verdict.failed);
    }

    #[test]
    fn a_slope_that_has_not_failed_is_said_to_stand_only_where_it_has_come_to_rest() {
        let at = |converged| [stage("gravity", StageKind::Static, Some(converged), None)];
        let text = |converged, status| Verdict::of(&at(converged), status).text;
        let finished = RunStatus::Finished;
        assert_eq!(text(true, finished), "the slope has not failed: largest displacement 0.0321 m in stage gravity");
        assert_eq!(
            text(false, finished),
            "no verdict: stage gravity did not come to rest, largest displacement 0.0321 m"
        );
        assert!(text(true, RunStatus::Interrupted).starts_with("no verdict yet"));
        assert!(text(true, RunStatus::Failed).starts_with("no verdict"));
    }
}
