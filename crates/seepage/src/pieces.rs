//! Connected pieces of a net.

/// The least node of the piece of each node, over pipes that conduct.
pub fn labels(nodes: usize, ends: &[[u32; 2]], conductance: &[f64]) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..nodes as u32).collect();
    for (&[a, b], &conducts) in ends.iter().zip(conductance) {
        if conducts > 0.0 {
            let (a, b) = (root(&mut parent, a), root(&mut parent, b));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    (0..nodes as u32).map(|node| root(&mut parent, node)).collect()
}

/// The least node of a piece; the way there is halved.
fn root(parent: &mut [u32], mut node: u32) -> u32 {
    while parent[node as usize] != node {
        let above = parent[parent[node as usize] as usize];
        parent[node as usize] = above;
        node = above;
    }
    node
}
