//! Input that makes no sense is refused by the name of the argument and the place in it.

use crate::parts::{FREE, held};
use enmm_seepage::{Condition, Failure, Net, Refused};

#[test]
fn nets_are_refused_for_heights_and_pipes() {
    let of =
        |heights: &[f64], pipes: &[[u32; 2]]| Net::new(heights, pipes).map(|_| ()).map_err(|error| error.to_string());
    assert_eq!(of(&[0.0, f64::NAN], &[]), Err("`heights` of 1 is NaN".to_owned()));
    let of_pipe = |ends| of(&[0.0, 1.0], &[[0, 1], ends]);
    assert_eq!(of_pipe([1, 2]), Err("pipe 1 leads from node 1 to node 2, and the net has 2 nodes".to_owned()));
    assert!(matches!(Net::new(&[0.0, 1.0], &[[1, 1]]), Err(Refused::Ends { pipe: 0, .. })));
    assert!(of(&[], &[]).is_ok());
}

#[test]
fn flows_are_refused_for_conductances_and_conditions() {
    let net = Net::new(&[0.0, 1.0, 2.0], &[[0, 1], [1, 2]]).unwrap();
    let of = |conductance: &[f64], first: Condition| {
        net.steady(conductance, &[first, FREE, FREE]).map(|_| ()).map_err(|error| error.to_string())
    };
    let held_at = |head: f64| of(&[1.0; 2], held(head));
    assert_eq!(of(&[1.0], FREE), Err("`conductance` has 1 values, and the net needs 2".to_owned()));
    assert_eq!(of(&[1.0, -1.0], FREE), Err("`conductance` of 1 is -1".to_owned()));
    assert_eq!(held_at(f64::INFINITY), Err("`head` of 0 is inf".to_owned()));
    assert_eq!(of(&[1.0; 2], Condition::Rain { rate: -2.0 }), Err("`rate` of 0 is -2".to_owned()));
    assert_eq!(of(&[1.0; 2], Condition::Free { source: f64::NAN }), Err("`source` of 0 is NaN".to_owned()));
    let enclosed = net.steady(&[1.0, 0.0], &[Condition::Free { source: 1.0 }, FREE, Condition::Air]);
    assert_eq!(enclosed, Err(Failure::Refused(Refused::Enclosed { node: 0 })));
    assert_eq!(
        net.steady(&[1.0; 2], &[FREE]),
        Err(Refused::Length { name: "conditions", length: 1, needed: 3 }.into())
    );
    assert!(held_at(1.0).is_ok());
}
