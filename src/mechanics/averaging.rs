//! Volume changes of rock that yields, averaged over physical covers, so that triangles do not lock where it flows
//! (Eqs. 58a–58c). A *patch* is the elements of one rock about one cover: averages stay on one side of joints, faces
//! and boundaries between rocks.

use rayon::prelude::*;

use crate::cover::{CoverId, Covers, ElementId};

use super::Deformation;

/// Share of a whole star below which a cover is light: its neighbours' stress would push it out of the face. From 0.15
/// to 0.3 the factor of a slope in soil changes by 0.4 %.
const LIGHT_STAR: f64 = 0.2;

/// Deformation of an element with what its rock feels of the patches about it, or its own where it is in none.
#[derive(Debug, Clone, Copy)]
pub struct Strained {
    /// Deformation.
    pub deformation: Deformation,
    /// Mean stress in the plane (Pa), without in-situ stress (Eq. 58b).
    pub mean: f64,
}

/// An element of a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Member {
    element: ElementId,
    /// Its share in the mean of the patch: A/(3V).
    share: f64,
}

/// Which elements average their volume changes, and with what shares. Empty where no rock yields.
#[doc(alias = "mixed discretisation")]
#[doc(alias = "B-bar")]
#[doc(alias = "volumetric locking")]
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Averaging {
    members: Vec<Member>,
    /// First member of each patch, and their number at the end.
    patch_start: Vec<u32>,
    /// The patches of each element; none where it keeps its own volume change.
    patches: Vec<Option<[PatchId; 3]>>,
}

crate::geometry::id! {
    /// A patch of elements that average their volume change.
    PatchId: optional
}

/// Elastic volume changes and mean stresses (Pa) in the plane, and how much of each the last step brought.
#[derive(Debug, Clone, Default)]
pub struct Averages {
    /// Volume change of each element.
    pub volume: Vec<[f64; 2]>,
    /// Mean stress of each element under the averaged volume change.
    pub mean: Vec<[f64; 2]>,
    /// Mean of the volume changes over each patch.
    pub patch_volume: Vec<[f64; 2]>,
    /// Mean of the mean stresses over each patch.
    pub patch_mean: Vec<[f64; 2]>,
}

/// Elements and patches that a thread takes together.
const RUN: usize = 1024;

/// Makes a list of what `value` gives for each of `count` indices.
pub fn list<T: Send + Default>(serial: bool, count: usize, list: &mut Vec<T>, value: impl Fn(usize) -> T + Sync) {
    list.resize_with(count, T::default);
    let fill = |(run, values): (usize, &mut [T])| {
        values.iter_mut().enumerate().for_each(|(k, place)| *place = value(run * RUN + k));
    };
    if serial {
        list.chunks_mut(RUN).enumerate().for_each(fill);
    } else {
        list.par_chunks_mut(RUN).enumerate().for_each(fill);
    }
}

impl Averages {
    /// Averages volume changes, and the mean stresses that `mean_stress` finds under them.
    pub fn average(
        &mut self,
        averaging: &Averaging,
        serial: bool,
        mean_stress: impl Fn(ElementId, [f64; 2]) -> [f64; 2] + Sync,
    ) {
        let Self { volume, mean, patch_volume, patch_mean } = self;
        list(serial, averaging.len(), patch_volume, |k| averaging.of_patch(k, |e| volume[e]));
        let averaged = |e| averaging.of_element(e, patch_volume).unwrap_or(volume[e]);
        list(serial, volume.len(), mean, |k| mean_stress(ElementId::new(k), averaged(ElementId::new(k))));
        list(serial, averaging.len(), patch_mean, |k| averaging.of_patch(k, |e| mean[e]));
    }

    /// Volume change and mean stress that the rock of an element feels, whose own volume change is given.
    #[inline]
    pub fn felt(&self, averaging: &Averaging, element: ElementId, volume: [f64; 2]) -> [[f64; 2]; 2] {
        let [felt, mean] = [&self.patch_volume, &self.patch_mean].map(|means| averaging.of_element(element, means));
        [felt.unwrap_or(volume), mean.unwrap_or_else(|| self.mean[element])]
    }
}

impl Averaging {
    /// The patches of all elements that can yield; elements with a light cover are in none.
    pub fn new(covers: &Covers, element_rock: &[u16], yields: impl Fn(ElementId) -> bool) -> Self {
        if !covers.elements().any(&yields) {
            return Self::default();
        }
        let light = light_covers(covers);
        let averages = |e: &ElementId| yields(*e) && !covers.element_covers[*e].iter().any(|&cover| light[cover]);
        let corners = |e: ElementId| (0..3).map(move |corner| (e, corner));
        let mut places: Vec<(ElementId, usize)> = covers.elements().filter(averages).flat_map(corners).collect();
        let patch_of = |&(e, corner): &(ElementId, usize)| (covers.element_covers[e][corner], element_rock[e]);
        places.sort_by_key(|place| (patch_of(place), place.0));
        let mut averaging = Self { patches: vec![None; covers.element_count()], ..Self::default() };
        for patch in places.chunk_by(|a, b| patch_of(a) == patch_of(b)) {
            averaging.push(covers, patch);
        }
        averaging.patch_start.push(averaging.members.len() as u32);
        averaging
    }

    fn push(&mut self, covers: &Covers, places: &[(ElementId, usize)]) {
        let id = PatchId::new(self.patch_start.len());
        self.patch_start.push(self.members.len() as u32);
        let area: f64 = places.iter().map(|place| covers.element_area[place.0]).sum();
        for &(element, corner) in places {
            self.members.push(Member { element, share: covers.element_area[element] / area });
            self.patches[element].get_or_insert([id; 3])[corner] = id;
        }
    }

    /// Number of patches.
    pub fn len(&self) -> usize {
        self.patch_start.len().saturating_sub(1)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Memory (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.members) + size_of_val(&*self.patch_start) + size_of_val(&*self.patches)
    }

    /// Mean over a patch of values that its elements have.
    #[inline]
    pub fn of_patch<const N: usize>(&self, patch: usize, value: impl Fn(ElementId) -> [f64; N]) -> [f64; N] {
        let members = self.patch_start[patch] as usize..self.patch_start[patch + 1] as usize;
        let mut mean = [0.0; N];
        for member in &self.members[members] {
            mean.iter_mut().zip(value(member.element)).for_each(|(mean, value)| *mean += member.share * value);
        }
        mean
    }

    /// Mean of what the three patches of an element have; none where it keeps its own value.
    #[inline]
    pub fn of_element<const N: usize>(&self, element: ElementId, means: &[[f64; N]]) -> Option<[f64; N]> {
        let patches = self.patches[element]?.map(|patch| means[patch]);
        Some(of_three(patches))
    }

    /// The same from the values of the elements about it: the same bits.
    pub fn around<const N: usize>(
        &self,
        element: ElementId,
        value: impl Fn(ElementId) -> [f64; N],
    ) -> Option<[f64; N]> {
        let patches = self.patches[element]?.map(|patch| self.of_patch(patch.index(), &value));
        Some(of_three(patches))
    }
}

fn of_three<const N: usize>([a, b, c]: [[f64; N]; 3]) -> [f64; N] {
    std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0)
}

/// Whether each cover has lost so much of its star to a cut that it is light.
fn light_covers(covers: &Covers) -> Vec<bool> {
    let whole = 3f64.sqrt() / 2.0 * covers.mesh.size.powi(2);
    let mut volume = vec![0.0; covers.cover_count()];
    for e in covers.elements() {
        covers.element_covers[e].iter().for_each(|&cover: &CoverId| volume[cover] += covers.element_area[e] / 3.0);
    }
    volume.iter().map(|volume| *volume < LIGHT_STAR * whole).collect()
}
