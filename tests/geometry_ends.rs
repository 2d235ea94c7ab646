//! Ends of traces that almost meet a line.

use enmm::geometry::ends::{EndChange, EndDistances, EndLine, NearEnd, join_ends};
use enmm::geometry::{Point, TraceId, polygon};

const DISTANCES: EndDistances = EndDistances { tolerance: 1e-6, join: 0.1, list: 1.0 };

fn square() -> Vec<Point> {
    [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]].map(Point::from).to_vec()
}

/// Joins the ends of traces in a square of 10 m.
fn join(traces: &mut [Vec<Point>]) -> Vec<NearEnd> {
    join_in(&square(), traces)
}

fn join_in(outline: &[Point], traces: &mut [Vec<Point>]) -> Vec<NearEnd> {
    let outlines: Vec<[Point; 2]> = polygon::sides(outline).map(|(a, b)| [a, b]).collect();
    let mut lines: Vec<&mut Vec<Point>> = traces.iter_mut().collect();
    join_ends(&outlines, &mut lines, &DISTANCES, |p| polygon::contains(outline, p)).expect("few lines")
}

fn line(points: &[[f64; 2]]) -> Vec<Point> {
    points.iter().map(|&p| Point::from(p)).collect()
}

fn changes(ends: &[NearEnd]) -> Vec<(EndChange, EndLine)> {
    ends.iter().map(|end| (end.change, end.line)).collect()
}

#[test]
fn an_end_goes_on_to_the_face_in_its_own_direction() {
    let mut traces = [line(&[[0.003, 5.0], [10.0 - 0.06, 5.0 + 0.03]])];
    let ends = join(&mut traces);
    assert_eq!(changes(&ends), [(EndChange::Extended, EndLine::Outline); 2]);
    assert!((ends[0].gap - 0.003).abs() < 1e-7 && ends[0].place == Point::new(0.003, 5.0));
    assert!(traces[0][0].x.abs() < 1e-12 && (traces[0][1].x - 10.0).abs() < 1e-12);
    assert!((traces[0][1].y - 5.03).abs() < 1e-3, "{:?}", traces[0]);
}

#[test]
fn an_end_beyond_a_trace_is_trimmed_and_one_before_it_extended() {
    let across = line(&[[5.0, 0.0], [5.0, 10.0]]);
    let mut traces = [across, line(&[[0.0, 3.0], [5.05, 3.0]]), line(&[[10.0, 7.0], [5.05, 7.0]])];
    let ends = join(&mut traces);
    let on = EndLine::Trace(TraceId::new(0));
    assert_eq!(changes(&ends), [(EndChange::Trimmed, on), (EndChange::Extended, on)]);
    assert!(traces[1..].iter().all(|trace| (trace[1].x - 5.0).abs() < 1e-12));
}

#[test]
fn an_end_beside_a_line_bends_to_it_and_its_meetings_stay() {
    let (beside, across) = (line(&[[0.0, 5.0], [10.0, 5.0]]), line(&[[9.0, 0.0], [9.0, 10.0]]));
    let mut traces = [beside, across, line(&[[0.0, 5.05], [9.5, 5.05]])];
    let ends = join(&mut traces);
    assert_eq!(changes(&ends), [(EndChange::Extended, EndLine::Trace(TraceId::new(0)))]);
    assert_eq!(traces[2], line(&[[0.0, 5.05], [9.0, 5.05], [9.5, 5.0]]));
}

#[test]
fn ends_that_face_each_other_meet_once() {
    let mut traces = [line(&[[0.0, 5.0], [4.0, 5.0]]), line(&[[10.0, 5.01], [4.02, 5.01]])];
    let ends = join(&mut traces);
    assert_eq!(changes(&ends), [(EndChange::Extended, EndLine::Trace(TraceId::new(1)))]);
    assert_eq!(traces[0].last(), traces[1].last());
}

#[test]
fn an_end_farther_off_is_listed_and_one_deep_in_the_rock_is_not() {
    let drawn = [line(&[[0.5, 5.0], [4.0, 5.0]]), line(&[[0.0, 8.0], [5.0, 8.0]])];
    let mut traces = drawn.clone();
    let ends = join(&mut traces);
    assert_eq!(changes(&ends), [(EndChange::Kept, EndLine::Outline)]);
    assert!((ends[0].gap - 0.5).abs() < 1e-12);
    assert_eq!(traces, drawn);
}

#[test]
fn a_copy_of_a_trace_does_not_hold_its_end() {
    let drawn = line(&[[0.0, 5.0], [9.99, 5.0]]);
    let mut traces = [drawn.clone(), drawn.clone()];
    assert_eq!(changes(&join(&mut traces)), [(EndChange::Extended, EndLine::Outline)]);
    assert_eq!((traces[0][1].x, &traces[1]), (10.0, &drawn));
}

#[test]
fn an_overshoot_is_not_listed() {
    let across = line(&[[5.0, 0.0], [5.0, 10.0]]);
    let drawn = [across, line(&[[0.0, 3.0], [5.5, 3.0]])];
    let mut traces = drawn.clone();
    assert_eq!(join(&mut traces), []);
    assert_eq!(traces, drawn);
}

/// The bend of a short trace leaves its first point to its other end.
#[test]
fn both_ends_of_a_short_trace_are_joined() {
    let mut traces = [line(&[[5.0, 9.95], [5.0, 9.0]]), line(&[[4.0, 8.95], [6.0, 8.95]])];
    let ends = join(&mut traces);
    assert_eq!(ends.len(), 2, "{ends:?}");
    assert!((traces[0][0].y - 10.0).abs() < 1e-12 && (traces[0][1].y - 8.95).abs() < 1e-12);
}

/// A plane drawn to the toe whose end lies in the ground below it: the nearest point is ground in front of the toe.
#[test]
fn an_end_beside_a_corner_of_the_outline_goes_to_the_corner() {
    let slope = line(&[[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [12.0, 10.0], [10.0, 5.0], [0.0, 5.0]]);
    let from = [20.0, 9.0];
    for end in [[9.999, 4.999], [9.95, 4.95], [9.98, 4.92], [10.01, 4.95]] {
        let mut traces = [line(&[from, end])];
        assert_eq!(changes(&join_in(&slope, &mut traces)), [(EndChange::Extended, EndLine::Outline)]);
        assert_eq!(traces[0].last(), Some(&Point::new(10.0, 5.0)), "{end:?}");
    }
    // Too far from the corner; above it, the line itself meets the face.
    for (end, meets) in [([9.8, 4.99], [9.8, 5.0]), ([10.04, 5.05], [10.016, 5.0406])] {
        let mut traces = [line(&[from, end])];
        join_in(&slope, &mut traces);
        assert!((traces[0][traces[0].len() - 1] - Point::from(meets)).norm() < 0.05, "{:?}", traces[0]);
        assert!(traces[0].iter().all(|p| (p - Point::new(10.0, 5.0)).norm() > 0.01), "{:?}", traces[0]);
    }
}
