//! Bolts yield, break and unload as their law says, worked out by hand.

use enmm::geometry::{Point, Vector};
use enmm::internals::contact::{BoltRow, Pair};
use enmm::model::tables::{BlockId, CoverId};
use enmm::model::{BoltCondition, BoltSegment, BoltState};

fn bar() -> BoltSegment {
    BoltSegment {
        bolt: 0,
        blocks: [BlockId::default(); 2],
        covers: [[CoverId::default(); 3]; 2],
        weights: [[1.0, 0.0, 0.0]; 2],
        points: [Point::zeros(), Point::new(1.0, 0.0)],
        stiffness: 100.0,
        yield_force: 20.0,
        rupture: 0.5,
        pretension: 5.0,
        active: true,
        grout: None,
        follows: false,
    }
}

#[test]
fn a_bar_yields_unloads_elastically_and_breaks() {
    let bar = bar();
    let new = bar.install(1.0);
    assert_eq!((new.rest, new.natural, new.force), (0.95, 0.95, 5.0));
    let stretched = bar.after(&new, 1.25, 20.0);
    // 20 of 30 are elastic: the rest length grows by 10/100.
    assert!((stretched.rest - 1.05).abs() < 1e-15 && !stretched.broken);
    assert!((bar.energy(&stretched, 1.25) - 2.0).abs() < 1e-12);
    let back = bar.after(&stretched, 1.1, 5.0);
    assert_eq!(back.rest, stretched.rest);
    let gone = bar.after(&back, 1.46, 20.0);
    assert!(gone.broken && gone.force == 0.0 && bar.energy(&gone, 1.46) == 0.0);
}

#[test]
fn the_answer_is_the_force_at_the_end_of_the_step() {
    let row = BoltRow {
        segment: 0,
        pair: Pair::default(),
        arms: [Vector::zeros(); 2],
        direction: Vector::x(),
        length: 1.0,
        rest: 0.9,
        stiffness: 100.0,
        yield_force: 20.0,
        compliance: 0.3,
        approach: 0.0,
        force: 4.0,
        stays: false,
    };
    let (dt, rate) = (0.1, 0.2);
    let force = row.answer(rate, dt, dt, 4.0);
    // κ = 100·0.3·0.01 = 0.3, and the change of force changes the rate: T = k·(l + θ·dt·(u − W·dt·(T − T0)) −
    // rest).
    let end = 1.0 + 4.0 * 0.3 / 1.3 * dt * (rate - 0.3 * dt * (force - 4.0));
    assert!((force - 100.0 * (end - 0.9)).abs() < 1e-12);
    assert_eq!([row.answer(-1e3, dt, dt, 4.0), row.answer(1e3, dt, dt, 4.0)], [0.0, 20.0]);
}

#[test]
fn a_bolt_without_its_rock_is_absent_whatever_it_did() {
    let slack = BoltState { active: true, rest: 2.0, natural: 2.0, ..BoltState::default() };
    let elastic = BoltState { force: 1e5, ..slack };
    let yielded = BoltState { rest: 2.1, ..elastic };
    let broken = BoltState { broken: true, force: 0.0, ..yielded };
    let all = [slack, elastic, yielded, broken];
    let conditions = all.map(|now| now.condition());
    let expected = [BoltCondition::Slack, BoltCondition::Elastic, BoltCondition::Yielded, BoltCondition::Broken];
    assert_eq!(conditions, expected);
    assert_eq!(conditions.map(BoltCondition::number), [1, 1, 2, 3]);
    assert!(all.iter().all(|now| BoltState { active: false, ..*now }.condition() == BoltCondition::Absent));
}
