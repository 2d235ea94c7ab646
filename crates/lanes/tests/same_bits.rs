//! Every kind of lanes gives the bits of the portable one, operation by operation.

use enmm_lanes::{
    Arithmetic, First, Kernel, LANES, Lanes, Pair, Path, Places, SLOTS, Slot, Table, Values, as_pairs, dispatch_on,
};

/// Numbers of all sizes and both signs, and a zero.
fn numbers(seed: u64) -> [f64; LANES] {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    std::array::from_fn(|k| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let unit = (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
        if k == 3 { 0.0 } else { unit * 10f64.powi((state % 21) as i32 - 10) }
    })
}

/// All operations, one after the other.
struct Everything(u64);

impl Kernel for Everything {
    type Output = Vec<u64>;

    fn run<L: Lanes>(self, lanes: L) -> Vec<u64> {
        let (a, b) = (lanes.load(&numbers(self.0)), lanes.load(&numbers(self.0 + 1)));
        let [pairs, some] = [0, 1].map(|k| {
            let (x, y) = (numbers(self.0 + k), numbers(self.0 + k + 2));
            std::array::from_fn::<Pair, LANES, _>(|i| Pair::new(x[i], y[i]))
        });
        let [x, y] = lanes.load_pairs(&pairs);
        let [z, w] = lanes.load_some_pairs(&some[..5], Pair::new(1.0, -2.0));
        let part = lanes.load_some(&numbers(self.0)[..3], 7.0);
        let mut table = Table::default();
        for (k, pair) in table.first_mut(40).iter_mut().enumerate() {
            *pair = pairs[k % LANES] * (k as f64 + 0.1);
        }
        let slots = [3, 1, 4, 1, 5, 39, 2, 6].map(Slot::new);
        lanes.scatter_add(&mut table, &slots, [x, b]);
        for run in [[SLOTS - 1, 3], [4, SLOTS - 1], [9, 13]] {
            let last = lanes.scatter_triangles(&mut table, run.map(Slot::new), [a, y], [b, x]);
            table.add_beside(Slot::new(run[0]), last);
        }
        let [g, h] = lanes.gather(&table, &slots);
        let [[i, j], [k, l]] = lanes.gather_triangles(&table, [7, SLOTS - 1].map(Slot::new));
        let mut stored = [Pair::zeros(); 6];
        lanes.store_some_pairs([z, w], &mut stored);
        let one = lanes.splat(1.0);
        let selected = lanes.select(0b1010_0110, a, b);
        let values = [
            a + b,
            a - b,
            a * b,
            a / (b * b + one),
            -a,
            lanes.sqrt(a * a),
            x,
            y,
            z,
            w,
            part,
            g,
            h,
            i,
            j,
            k,
            l,
            selected,
        ];
        let mut bits = Vec::new();
        let masks = [(a, b), (b, a), (a, a), (x, w), (lanes.sqrt(-a), b)].map(|(a, b)| lanes.at_most(a, b));
        bits.extend(masks.map(u64::from));
        for value in values {
            let mut out = [0.0; LANES];
            lanes.store(value, &mut out);
            bits.extend(out.map(f64::to_bits));
            bits.extend([lanes.sum(value), lanes.greatest(value)].map(f64::to_bits));
        }
        let pairs = table.first(SLOTS).iter().chain(&stored);
        bits.extend(pairs.flat_map(|p| [p.x.to_bits(), p.y.to_bits()]));
        lanes.clear(&mut table, 13);
        bits.extend(table.first(40).iter().flat_map(|p| [p.x.to_bits(), p.y.to_bits()]));
        bits
    }
}

/// Operations that the first lane alone has as well: the values of each, and a list that was written to.
fn common<V: Values>(lanes: V, seed: u64) -> (Vec<[f64; LANES]>, Vec<Pair>) {
    let (a, b) = (lanes.load(&numbers(seed)), lanes.load(&numbers(seed + 1)));
    let mut list: Vec<Pair> = numbers(seed + 2).iter().map(|&x| Pair::new(x, -3.0 * x)).collect();
    let [x, y] = lanes.gather_from(&list, &Places::new(&[5, 0, 4, 4, 7, 3, 1, 2]));
    lanes.scatter_to([x, a], &mut list, &Places::new(&[6, 2, 6, 3, 2, 1, 0, 5]));
    let one = lanes.splat(1.0);
    let of_two = [a + b, a - b, a * b, a / (b * b + one), lanes.max(a, b), lanes.min(a, b)];
    let numbers = [[1.5, -2.0], [f64::MIN_POSITIVE, 1e300]].repeat(LANES);
    let [z, w] = lanes.gather_from(as_pairs(&numbers), &Places::in_steps(1, 2));
    let alone = [-a, lanes.keep_above(a, b, x), x, y, z, w, a.splat(-0.3)];
    let values = of_two.into_iter().chain(alone).map(|value| {
        let mut out = [0.0; LANES];
        lanes.store(value, &mut out);
        out
    });
    (values.collect(), list)
}

struct Common(u64);

impl Kernel for Common {
    type Output = (Vec<[f64; LANES]>, Vec<Pair>);

    fn run<L: Lanes>(self, lanes: L) -> Self::Output {
        common(lanes, self.0)
    }
}

#[test]
fn all_paths_give_the_bits_of_the_portable_one() {
    let bits = |(values, list): (Vec<[f64; LANES]>, Vec<Pair>)| -> Vec<u64> {
        let pairs = list.iter().flat_map(|p| [p.x, p.y]);
        values.into_iter().flatten().chain(pairs).map(f64::to_bits).collect()
    };
    for seed in 0..200 {
        let expected = dispatch_on(Path::Portable, Everything(seed));
        let common = bits(dispatch_on(Path::Portable, Common(seed)));
        for path in Path::all() {
            assert!(dispatch_on(path, Everything(seed)) == expected, "{} at {seed}", path.name());
            assert!(bits(dispatch_on(path, Common(seed))) == common, "{} at {seed}", path.name());
        }
    }
}

#[test]
fn the_first_lane_alone_has_the_bits_of_the_first_of_eight() {
    for seed in 0..200 {
        let (all, list) = dispatch_on(Path::Portable, Common(seed));
        let (first, first_list) = common(First, seed);
        for (all, first) in all.iter().zip(&first) {
            assert_eq!(all[0].to_bits(), first[0].to_bits(), "at {seed}");
        }
        assert_eq!(list[6], first_list[6], "at {seed}");
    }
}

#[test]
#[should_panic(expected = "slot 4096")]
fn a_slot_outside_the_table_is_refused() {
    Slot::new(SLOTS);
}

#[test]
#[should_panic(expected = "place 7 of 7")]
fn a_place_outside_the_list_is_refused() {
    struct Beyond;
    impl Kernel for Beyond {
        type Output = ();
        fn run<L: Lanes>(self, lanes: L) {
            lanes.gather_from(&[Pair::zeros(); 7], &Places::new(&[0, 1, 2, 3, 7, 5, 6, 4]));
        }
    }
    dispatch_on(Path::all()[Path::all().len() - 1], Beyond);
}
