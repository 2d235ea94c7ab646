//! Parts of the engine that stand alone do what closed forms and hand calculations say: polygons, loops, joint sets,
//! free-field columns, bolts.

mod polygons {
    use enmm::geometry::polygon::*;
    use enmm::geometry::{Point, Vector};

    fn polygon(list: &[[f64; 2]]) -> Vec<Point> {
        list.iter().map(|p| Point::new(p[0], p[1])).collect()
    }

    fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Vec<Point> {
        polygon(&[[x, y], [x + width, y], [x + width, y + height], [x, y + height]])
    }

    /// A comb: a bar with three teeth upwards, 2 wide, 1 apart, 3 high.
    fn comb() -> Vec<Point> {
        let mut list = vec![[0.0, -1.0], [8.0, -1.0]];
        for k in [2.0, 1.0, 0.0] {
            let x = 3.0 * k;
            list.extend([[x + 2.0, 0.0], [x + 2.0, 3.0], [x, 3.0], [x, 0.0]]);
        }
        polygon(&list)
    }

    #[test]
    fn moments_of_a_far_rectangle_match_the_closed_form() {
        // ∫x² over [0,w] is w³h/3, ∫xy is w²h²/4; the far position must not cost digits of area and centroid.
        let (w, h, far) = (3.0, 2.0, Vector::new(4.0e6, 6.0e6));
        let position = |k: &Point| k + far;
        let shape: Vec<Point> = rectangle(0.0, 0.0, w, h).iter().map(position).collect();
        let m = Moments::of(&shape, far);
        assert_eq!(m.area, 6.0);
        assert_eq!(m.first, Vector::new(9.0, 6.0));
        for (found, exact) in m.second.iter().zip([18.0, 8.0, 9.0]) {
            assert!((found - exact).abs() < 1e-14 * exact, "{found} {exact}"); // a few roundings of numbers of order 10
        }
        assert_eq!(centroid(&shape), far + Vector::new(1.5, 1.0));
        let about_origin = Moments::of(&shape, Point::zeros());
        let back = about_origin.shifted(-far);
        assert!((back.first - m.first).norm() < 1e-8); // 6e6·6 rounds to 7e-9
    }

    #[test]
    fn moments_add_up_over_parts() {
        let whole = Moments::of(&rectangle(1.0, 2.0, 4.0, 3.0), Point::zeros());
        let parts = Moments::of(&rectangle(1.0, 2.0, 1.5, 3.0), Point::zeros())
            + Moments::of(&rectangle(2.5, 2.0, 2.5, 3.0), Point::zeros());
        assert!((whole.area - parts.area).abs() < 1e-13 && (whole.first - parts.first).norm() < 1e-12);
        assert!(whole.second.iter().zip(parts.second).all(|(a, b)| (a - b).abs() < 1e-11)); // sums near 300
    }

    #[test]
    fn boundary_is_inside_and_the_notch_is_not() {
        let comb = comb();
        for p in [[0.0, 0.0], [8.0, 3.0], [1.0, 3.0], [5.0, 1.5], [2.5, 0.0], [4.0, -1.0]] {
            assert!(contains(&comb, Point::new(p[0], p[1])), "{p:?}");
        }
        for p in [[2.5, 1.0], [5.5, 3.0], [-1e-300, 0.0], [8.0 + 1e-15, 3.0 + 1e-15], [9.0, 0.0], [-1.0, 3.0]] {
            assert!(!contains(&comb, Point::new(p[0], p[1])), "{p:?}");
        }
    }

    #[test]
    fn triangles_of_a_comb_cover_it_once() {
        let total: f64 = triangles(&comb()).iter().map(|t| area(t)).sum();
        assert_eq!(total, 26.0);
        let mut clockwise = comb();
        clockwise.reverse();
        assert_eq!(triangles(&clockwise).iter().map(|t| area(t)).sum::<f64>(), 26.0);
    }

    #[test]
    fn overlap_of_a_bar_across_a_comb_is_its_three_teeth() {
        let bar = rectangle(-1.0, 1.0, 12.0, 0.25);
        assert!((overlap_area(&comb(), &bar) - 1.5).abs() < 1e-13);
        // No corner of one lies in the other; triangles of the comb narrow the pieces, convex shapes stay whole.
        let depth = overlap_depth(&comb(), &bar);
        assert!(depth > 0.1 && depth <= 0.25, "{depth}");
        assert!((overlap_depth(&rectangle(0.0, 0.0, 2.0, 3.0), &bar) - 0.25).abs() < 1e-15);
    }

    #[test]
    fn depth_of_a_corner_in_a_face_is_its_distance() {
        let base = rectangle(-5.0, -2.0, 10.0, 2.0);
        let corner = polygon(&[[0.0, -0.01], [1.0, 1.0], [-1.0, 1.0]]);
        assert!((overlap_depth(&base, &corner) - 0.01).abs() < 1e-14);
        assert_eq!(overlap_depth(&base, &rectangle(0.0, 0.0, 1.0, 1.0)), 0.0);
        assert_eq!(overlap_area(&base, &rectangle(0.0, 0.0, 1.0, 1.0)), 0.0);
    }

    #[test]
    fn polygon_that_touches_itself_keeps_its_area() {
        // A square with a triangular notch whose tip touches the opposite side.
        let shape =
            polygon(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.5, 2.0], [1.0, 0.0], [0.5, 2.0], [0.0, 2.0]]);
        let total: f64 = triangles(&shape).iter().map(|t| area(t)).sum();
        assert!((total - area(&shape)).abs() < 1e-14);
    }
}

mod loops {
    use enmm::geometry::loops::*;
    use enmm::geometry::polygon::area;
    use enmm::geometry::{GeometryError, Point};

    fn square(x: f64, y: f64, side: f64) -> Vec<Point> {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|p| Point::new(x + side * p[0], y + side * p[1])).to_vec()
    }

    fn circle(count: usize) -> Vec<Point> {
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / count as f64;
        (0..count).map(|k| Point::new(angle(k).cos(), angle(k).sin())).collect()
    }

    #[test]
    fn clockwise_loop_with_closing_point_comes_back_counter_clockwise() {
        let mut points = square(1.0, 1.0, 2.0);
        points.reverse();
        points.push(points[0]);
        let valid = validate_loop(&points, "outline").unwrap();
        assert_eq!(valid.len(), 4);
        assert_eq!(area(&valid), 4.0);
    }

    #[test]
    fn useless_loops_are_refused_by_name() {
        let point = Point::new;
        let bow = [point(0.0, 0.0), point(2.0, 2.0), point(2.0, 0.0), point(0.0, 2.0)];
        let Err(GeometryError::SelfIntersection { x, y, .. }) = validate_loop(&bow, "bow") else { panic!("bow") };
        assert_eq!((x, y), (1.0, 1.0));
        let spike = [point(0.0, 0.0), point(2.0, 0.0), point(1.0, 0.0), point(1.0, 1.0)];
        assert!(matches!(validate_loop(&spike, "spike"), Err(GeometryError::SelfIntersection { .. })));
        let touch = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]].map(|p| point(p[0], p[1]));
        assert!(matches!(validate_loop(&touch, "touch"), Err(GeometryError::SelfIntersection { .. })));
        let flat = [point(0.0, 0.0), point(1.0, 0.0), point(0.5, 1e-14)];
        assert!(matches!(validate_loop(&flat, "flat"), Err(GeometryError::NoArea { .. })));
        let two = [point(0.0, 0.0), point(1.0, 0.0), point(1.0, 0.0), point(0.0, 0.0)];
        assert!(matches!(validate_loop(&two, "two"), Err(GeometryError::TooFewPoints { found: 2, .. })));
        let nan = [point(0.0, 0.0), point(f64::NAN, 0.0), point(1.0, 1.0)];
        let message = validate_loop(&nan, "hole 3").unwrap_err().to_string();
        assert!(message.contains("hole 3") && message.contains("point 1"), "{message}");
    }

    #[test]
    fn large_loops_are_checked_in_about_linear_time() {
        // A quadratic check of 200 000 sides takes minutes; only a run that never ends can fail here.
        let mut points = circle(200_000);
        assert!(validate_loop(&points, "circle").is_ok());
        points.swap(70_000, 70_001);
        assert!(matches!(validate_loop(&points, "circle"), Err(GeometryError::SelfIntersection { .. })));
    }

    #[test]
    fn holes_and_islands_must_be_in_place() {
        let outline = square(0.0, 0.0, 10.0);
        let holes = vec![square(1.0, 1.0, 3.0), square(5.0, 5.0, 3.0)];
        let in_hole = square(2.0, 2.0, 1.0);
        let outside = square(20.0, 0.0, 5.0);
        let on_top = square(2.0, 10.0, 2.0);
        assert_eq!(validate_holes(&outline, &holes, &[in_hole.clone(), outside, on_top]), Ok(()));
        let error =
            |holes: &[Vec<Point>], islands: &[Vec<Point>]| validate_holes(&outline, holes, islands).unwrap_err();
        let meet = error(&[square(8.0, 8.0, 3.0)], &[]);
        assert!(matches!(meet, GeometryError::LoopsMeet { .. }), "{meet}");
        let away = error(&[square(18.0, 8.0, 3.0)], &[]);
        assert!(matches!(away, GeometryError::HoleMisplaced { hole: 0, .. }), "{away}");
        let nested = error(&[square(1.0, 1.0, 3.0), square(2.0, 2.0, 1.0)], &[]);
        assert!(matches!(nested, GeometryError::HoleMisplaced { hole: 1, .. }), "{nested}");
        for island in [square(6.0, 1.0, 1.0), square(3.0, 3.0, 2.0), square(-20.0, -20.0, 50.0)] {
            let on_rock = error(&holes, &[in_hole.clone(), island]);
            assert!(matches!(on_rock, GeometryError::IslandOnRock { island: 1, .. }), "{on_rock}");
        }
        let twice = error(&holes, &[in_hole.clone(), in_hole.clone()]);
        assert!(matches!(twice, GeometryError::IslandOnRock { island: 1, .. }), "{twice}");
    }
}

mod columns {
    use enmm::cover::BlockId;
    use enmm::geometry::Vector;
    use enmm::mechanics::{Column, ColumnDrive, ColumnState, Elasticity, Foot};

    fn column(foot: Foot) -> Column {
        let rock = Elasticity { lambda: 2.0, mu: 1.0, density: 1.0 };
        Column { foot_height: 1.0, spacing: 0.5, rocks: vec![rock; 40], blocks: vec![BlockId::default(); 41], foot }
    }

    /// Runs a column of c_s = 1 and c_p = 2 m/s, 20 m high.
    fn run(column: &Column, drive: impl Fn(f64) -> ColumnDrive, seconds: f64) -> ColumnState {
        let mut state = ColumnState::at_rest(column.node_count());
        let mut after = state.velocity.clone();
        let dt = 0.2;
        for step in 0..(seconds / dt) as u32 {
            let drive = ColumnDrive { kick: if step == 0 { 0.5 * dt } else { dt }, ..drive(f64::from(step) * dt) };
            column.kick(&state, &drive, |_| 1.0, &mut after);
            state.velocity.copy_from_slice(&after);
            state.displacement.iter_mut().zip(&after).for_each(|(u, v)| *u += v * dt);
        }
        state
    }

    /// A velocity of 1 m/s enters and has reached 15 m by shear and all of the column, doubled at its head, by
    /// pressure.
    #[test]
    fn a_wave_enters_through_a_quiet_foot_and_doubles_at_the_head() {
        let wave = |_| ColumnDrive { acceleration: Vector::zeros(), wave: Vector::new(1.0, 1.0), kick: 0.0 };
        let state = run(&column(Foot::Quiet(0)), wave, 15.0);
        let mean = |range: std::ops::Range<usize>, axis: usize| {
            let count = range.len() as f64;
            state.velocity[range].iter().map(|v| v[axis]).sum::<f64>() / count
        };
        assert!((mean(2..20, 0) - 1.0).abs() < 0.02 && mean(36..41, 0).abs() < 0.02, "{:?}", state.velocity);
        assert!((mean(32..41, 1) - 2.0).abs() < 0.05 && (mean(2..14, 1) - 1.0).abs() < 0.05, "{:?}", state.velocity);
    }

    /// Under a constant acceleration the head of a rigid-footed column swings to twice a·ρH²/2μ at half its period
    /// 4H/c.
    #[test]
    fn a_rigid_foot_holds_the_column() {
        let push = |_| ColumnDrive { acceleration: Vector::new(0.1, 0.0), wave: Vector::zeros(), kick: 0.0 };
        let state = run(&column(Foot::Rigid), push, 40.0);
        assert_eq!(state.displacement[0], Vector::zeros());
        assert!((state.displacement[40].x - 40.0).abs() < 0.4, "{}", state.displacement[40]);
    }

    #[test]
    fn places_lie_in_their_cells() {
        let column = column(Foot::Rigid);
        let field: Vec<Vector> = (0..41).map(|k| Vector::new(f64::from(k), 0.0)).collect();
        for (y, expected) in [(1.0, 0.0), (1.2, 0.4), (21.0, 40.0), (30.0, 40.0)] {
            assert!((column.position(y).sample(&field).x - expected).abs() < 1e-12);
        }
    }
}

mod bolts {
    use enmm::contact::{BoltRow, BoltSegment, Pair};
    use enmm::cover::{BlockId, CoverId};
    use enmm::geometry::{Point, Vector};

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
        };
        let (dt, rate) = (0.1, 0.2);
        let force = row.answer(rate, dt, dt, 4.0);
        // κ = 100·0.3·0.01 = 0.3, and the change of force changes the rate: T = k·(l + θ·dt·(u − W·dt·(T − T0)) −
        // rest).
        let end = 1.0 + 4.0 * 0.3 / 1.3 * dt * (rate - 0.3 * dt * (force - 4.0));
        assert!((force - 100.0 * (end - 0.9)).abs() < 1e-12);
        assert_eq!([row.answer(-1e3, dt, dt, 4.0), row.answer(1e3, dt, dt, 4.0)], [0.0, 20.0]);
    }
}

mod joint_sets {
    use enmm::geometry::joint_set::*;
    use enmm::geometry::polygon::contains;
    use enmm::geometry::{GeometryError, Point};

    const SET: JointSetParameters = JointSetParameters {
        dip: 0.3,
        dip_sd: 0.05,
        turn: Turn::Normal,
        spacing: 0.5,
        spacing_sd: 0.2,
        spacing_spread: Spread::Normal,
        trace_length: Some(3.0),
        trace_length_sd: 1.0,
        length_spread: Spread::Normal,
        gap: 0.4,
        seed: 11,
        origin: None,
    };

    fn points(list: &[[f64; 2]]) -> Vec<Point> {
        list.iter().map(|p| Point::new(p[0], p[1])).collect()
    }

    fn square() -> Vec<Point> {
        points(&[[0.0, 0.0], [50.0, 0.0], [50.0, 50.0], [0.0, 50.0]])
    }

    #[test]
    fn same_seed_same_traces_and_another_seed_others() {
        assert_eq!(generate(&SET, &square()), generate(&SET, &square()));
        assert_ne!(generate(&SET, &square()), generate(&JointSetParameters { seed: 12, ..SET }, &square()));
    }

    #[test]
    fn density_follows_spacing_length_and_gap() {
        // Length per area is (length/(length+gap))/spacing = 1.7647 per metre. About 100 lines of 50 m: the mean
        // spacing scatters by 0.2/sqrt(100) of 0.5, 4 %; so 10 % is 2.5 standard deviations, for one fixed seed.
        let traces = generate(&SET, &square()).unwrap();
        let length: f64 = traces.iter().map(|t| (t[1] - t[0]).norm()).sum();
        let density = length / 2500.0;
        assert!((density / 1.7647 - 1.0).abs() < 0.1, "{density}");
        let mean = traces.iter().map(|t| (t[1] - t[0]).y.atan2((t[1] - t[0]).x)).sum::<f64>() / traces.len() as f64;
        // 0.05/sqrt(1600) = 0.00125 rad: four standard deviations.
        assert!((mean - SET.dip).abs() < 0.005, "{mean}");
    }

    #[test]
    fn traces_of_a_notched_region_stay_inside() {
        let region = points(&[[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [6.0, 8.0], [5.0, 2.0], [4.0, 8.0], [0.0, 8.0]]);
        let through =
            JointSetParameters { dip: 0.0, dip_sd: 0.0, spacing: 1.0, spacing_sd: 0.0, trace_length: None, ..SET };
        let traces = generate(&through, &region).unwrap();
        // Eight horizontal lines; the notch, from y = 2 upwards, cuts six of them in two.
        assert_eq!(traces.len(), 14);
        for [a, b] in generate(&SET, &region).unwrap().into_iter().chain(traces) {
            for k in 0..=10 {
                // Ends lie on the boundary up to round-off: look a little inwards.
                let p = a + (b - a) * (1e-9 + (1.0 - 2e-9) * f64::from(k) / 10.0);
                assert!(contains(&region, p), "{p}");
            }
        }
    }

    #[test]
    fn parameters_out_of_range_are_named() {
        let name = |set: JointSetParameters| generate(&set, &square()).unwrap_err().to_string();
        assert!(name(JointSetParameters { spacing: 0.0, ..SET }).contains("spacing"));
        assert!(name(JointSetParameters { spacing_sd: f64::NAN, ..SET }).contains("spacing_sd"));
        assert!(name(JointSetParameters { trace_length: Some(-1.0), ..SET }).contains("trace_length"));
        assert!(name(JointSetParameters { gap: f64::INFINITY, ..SET }).contains("gap"));
        let tiny = JointSetParameters { spacing: 1e-9, spacing_sd: 0.0, ..SET };
        assert!(matches!(generate(&tiny, &square()), Err(GeometryError::TooManyTraces { .. })));
    }
}
