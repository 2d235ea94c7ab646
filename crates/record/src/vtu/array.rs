//! Arrays of VTK files: named, in base64, in blocks that zlib has compressed.

use std::io::{self, Write};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use enmm::geometry::Vector;
use miniz_oxide::deflate::compress_to_vec_zlib;
use quick_xml::escape::escape;

/// Bytes that are compressed together.
const BLOCK: usize = 1 << 16;
/// Effort of the compression, of 0 to 10: frames of the fractured slope are 2.4 % larger than by 6, in a quarter of the
/// time.
const EFFORT: u8 = 1;

/// Hands the values of an array over, as little-endian bytes.
type Values<'a> = Box<dyn Fn(&mut dyn Write) -> io::Result<()> + 'a>;

/// A named array of VTK; its values are read when they are written, for a copy of all of them would be larger than the
/// model.
pub struct Array<'a> {
    pub name: &'static str,
    kind: &'static str,
    components: usize,
    /// Names of the components, if they have any.
    component_names: Vec<String>,
    /// Number of entries.
    pub count: usize,
    values: Values<'a>,
}

impl<'a> Array<'a> {
    fn new<const N: usize>(
        name: &'static str,
        kind: &'static str,
        values: impl ExactSizeIterator<Item = [u8; N]> + Clone + 'a,
    ) -> Self {
        let count = values.len();
        let each = move |text: &mut dyn Write| values.clone().try_for_each(|value| text.write_all(&value));
        Self { name, kind, components: 1, component_names: Vec::new(), count, values: Box::new(each) }
    }

    /// Real numbers.
    pub fn numbers(name: &'static str, values: impl ExactSizeIterator<Item = f64> + Clone + 'a) -> Self {
        Self::new(name, "Float64", values.map(f64::to_le_bytes))
    }

    /// Counts and indices.
    pub fn integers(name: &'static str, values: impl ExactSizeIterator<Item = usize> + Clone + 'a) -> Self {
        Self::new(name, "Int64", values.map(|value| (value as i64).to_le_bytes()))
    }

    /// Indices of a list.
    pub fn ids(name: &'static str, values: &'a [u32]) -> Self {
        Self::integers(name, values.iter().map(|&id| id as usize))
    }

    /// Small numbers.
    pub fn bytes(name: &'static str, values: impl ExactSizeIterator<Item = u8> + Clone + 'a) -> Self {
        Self::new(name, "UInt8", values.map(|value| [value]))
    }

    /// Vectors of the plane; the third component is zero.
    pub fn vectors(name: &'static str, values: impl ExactSizeIterator<Item = Vector> + Clone + 'a) -> Self {
        let bytes = |vector: Vector| {
            let mut bytes = [0; 24];
            bytes[..8].copy_from_slice(&vector.x.to_le_bytes());
            bytes[8..16].copy_from_slice(&vector.y.to_le_bytes());
            bytes
        };
        Self { components: 3, ..Self::new(name, "Float64", values.map(bytes)) }
    }

    /// Stresses of the plane (xx, yy, xy) as symmetric tensors: XX, YY, ZZ, XY, YZ, XZ.
    pub fn tensors(name: &'static str, values: &'a [[f64; 3]], out_of_plane: &'a [f64]) -> Self {
        let bytes = |(&[xx, yy, xy], &zz): (&[f64; 3], &f64)| {
            let mut bytes = [0; 48];
            for (k, part) in [xx, yy, zz, xy, 0.0, 0.0].into_iter().enumerate() {
                bytes[8 * k..8 * (k + 1)].copy_from_slice(&part.to_le_bytes());
            }
            bytes
        };
        let names = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"].map(str::to_owned).to_vec();
        Self {
            components: 6,
            component_names: names,
            ..Self::new(name, "Float64", values.iter().zip(out_of_plane).map(bytes))
        }
    }

    /// Meanings of numbers: one entry with a component of each name, whose value is the number of the name.
    pub fn names(name: &'static str, names: &[impl AsRef<str>]) -> Self {
        let numbers: Vec<u8> = (0..names.len() as i64).flat_map(i64::to_le_bytes).collect();
        Self {
            name,
            kind: "Int64",
            components: names.len(),
            component_names: names.iter().map(|name| name.as_ref().to_owned()).collect(),
            count: usize::from(!names.is_empty()),
            values: Box::new(move |text| text.write_all(&numbers)),
        }
    }

    /// Writes the array as an element of XML.
    pub fn xml(&self, file: &mut dyn Write) -> io::Result<()> {
        write!(file, "<DataArray type=\"{}\" Name=\"{}\"", self.kind, self.name)?;
        if self.components > 1 {
            write!(file, " NumberOfComponents=\"{}\"", self.components)?;
        }
        for (k, name) in self.component_names.iter().enumerate() {
            write!(file, " ComponentName{k}=\"{}\"", escape(name))?;
        }
        write!(file, " NumberOfTuples=\"{}\" format=\"binary\">", self.count)?;
        let mut blocks = Blocks::default();
        (self.values)(&mut blocks)?;
        blocks.finish(file)?;
        writeln!(file, "</DataArray>")
    }
}

/// Bytes that are compressed block by block as they come.
#[derive(Default)]
struct Blocks {
    plain: Vec<u8>,
    sizes: Vec<u64>,
    packed: Vec<u8>,
}

impl Blocks {
    fn pack(&mut self) {
        let block = compress_to_vec_zlib(&self.plain, EFFORT);
        self.sizes.push(block.len() as u64);
        self.packed.extend(block);
        self.plain.clear();
    }

    /// Writes the header (number of blocks, size of a block, size of the last one if it is shorter, sizes once
    /// compressed) and the blocks.
    fn finish(mut self, file: &mut dyn Write) -> io::Result<()> {
        let last = self.plain.len();
        if last > 0 {
            self.pack();
        }
        let header = [self.sizes.len() as u64, BLOCK as u64, last as u64].into_iter().chain(self.sizes);
        let header: Vec<u8> = header.flat_map(u64::to_le_bytes).collect();
        file.write_all(BASE64_STANDARD.encode(header).as_bytes())?;
        file.write_all(BASE64_STANDARD.encode(self.packed).as_bytes())
    }
}

impl Write for Blocks {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(BLOCK - self.plain.len());
        self.plain.extend_from_slice(&bytes[..taken]);
        if self.plain.len() == BLOCK {
            self.pack();
        }
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
