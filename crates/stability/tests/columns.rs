//! Columns that stand on steps and topple together, with the closed form of their factor.

/// Columns (width and height in m, from the toe up, each on a step .5 m above the last) under a gravity that is turned
/// by 20°; their base has 60° of friction, their sides 40° and `side` more.
pub fn columns(sizes: &[[f64; 2]], side: &str) -> String {
    let right: f64 = sizes.iter().map(|size| size[0]).sum();
    let mut outline = vec![[-6.0, -3.0], [right + 6.0, -3.0], [right + 6.0, 0.0]];
    let (mut x, mut joints) = (right, String::new());
    for (k, [width, height]) in sizes.iter().enumerate() {
        let foot = 0.5 * k as f64;
        if k == 0 {
            outline.push([x, foot]);
        }
        outline.extend([[x, foot + height], [x - width, foot + height]]);
        let [base, behind] = [[[x - width, foot], [x, foot]], [[x - width, foot], [x - width, foot + height]]];
        joints += &format!("[[joint]]\npoints = {base:?}\nlaw = \"base\"\n");
        if k + 1 < sizes.len() {
            joints += &format!("[[joint]]\npoints = {behind:?}\nlaw = \"side\"\n");
        }
        x -= width;
    }
    let top = 0.5 * (sizes.len() - 1) as f64;
    outline.extend([[0.0, top], [-6.0, top]]);
    let (sine, cosine) = 20f64.to_radians().sin_cos();
    format!(
        "title = \"columns\"\n[domain]\noutline = {outline:?}\njoint_law = \"base\"\n[mesh]\nsize = 1.0\n\
         origin = [0.13, 0.07]\n[gravity]\nx = {:?}\ny = {:?}\n[rock.rock]\ndensity = 2500.0\nyoung = 1e10\n\
         poisson = 0.25\n[joint_law.base]\nfriction_deg = 60.0\n[joint_law.side]\nfriction_deg = 40.0\n{side}\n\
         {joints}[[fix]]\nedge = [[-6.0, -3.0], [{:?}, -3.0]]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\n\
         duration = 60\n",
        9.81 * sine,
        -9.81 * cosine,
        right + 6.0
    )
}

/// Factor at which such columns topple: each turns about its lower corner and touches the next at that one's head,
/// where friction is fully mobilized; bases do not slip.
pub fn toppling(sizes: &[[f64; 2]]) -> f64 {
    let (sine, cosine) = 20f64.to_radians().sin_cos();
    let over = |factor: f64| {
        let (mut push, mut moment) = (0.0, 0.0);
        for (k, [width, height]) in sizes.iter().enumerate().rev() {
            let weight = 2500.0 * 9.81 * width * height;
            let drag = push * 40f64.to_radians().tan() / factor;
            moment = 0.5 * weight * (height * sine - width * cosine) + push * height - drag * width;
            push = if k > 0 { (moment / (sizes[k - 1][1] - 0.5)).max(0.0) } else { 0.0 };
        }
        moment
    };
    let halved = |[low, high]: [f64; 2]| {
        let middle = 0.5 * (low + high);
        if over(middle) > 0.0 { [low, middle] } else { [middle, high] }
    };
    (0..60).fold([0.1, 10.0], |bracket, _| halved(bracket))[0]
}

/// The upper one would topple alone; the lower one holds it.
pub const TWO: [[f64; 2]; 2] = [[2.4, 4.0], [2.0, 7.5]];
/// Two columns on the lowest, which holds both.
pub const THREE: [[f64; 2]; 3] = [[3.0, 4.5], [2.0, 6.5], [2.0, 8.5]];
