//! Numbers out of accessors: strides, normalized integers, sparse values.

use super::file::File;
use anyhow::{Context, Result, ensure};
use gltf::json::Index;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::buffer::View;
use gltf::json::validation::Checked;

/// Elements of an accessor that no bytes stand for (a sparse one over zeros).
pub const MOST_ZEROS: usize = 1 << 20;
/// No length or weight of a real motion comes near it.
const LARGEST: f64 = 1e9;

/// All numbers of an accessor, element after element, each of `components` numbers.
pub fn numbers(file: &File, index: usize, components: usize) -> Result<Vec<f64>> {
    let at = format!("accessors[{index}]");
    read(file, index, components).map_err(|error| file.error(&at, format!("{error:#}")))
}

/// The whole numbers of an accessor of single numbers.
pub fn indices(file: &File, index: usize) -> Result<Vec<usize>> {
    Ok(numbers(file, index, 1)?.into_iter().map(|x| x as usize).collect())
}

fn read(file: &File, index: usize, components: usize) -> Result<Vec<f64>> {
    let accessor = file.root.accessors.get(index).context("no such accessor")?;
    let Checked::Valid(kind) = accessor.type_ else { anyhow::bail!("unknown type") };
    let Checked::Valid(component) = accessor.component_type else { anyhow::bail!("unknown componentType") };
    let expected = match components {
        1 => Type::Scalar,
        3 => Type::Vec3,
        _ => Type::Vec4,
    };
    ensure!(kind == expected, "type {kind:?}; expected {expected:?}");
    let (count, form) = (usize::try_from(accessor.count.0)?, Form { kind: component.0, normalized: accessor.normalized });
    let mut values = match accessor.buffer_view {
        Some(view) => {
            let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
            form.elements(file, view, offset, count, components)?
        }
        None => {
            ensure!(count <= MOST_ZEROS, "{count} elements without a bufferView; at most {MOST_ZEROS} are read");
            vec![0.0; count * components]
        }
    };
    replace_sparse(file, accessor, form, components, &mut values)?;
    let wrong = values.iter().position(|value| !value.is_finite() || value.abs() > LARGEST);
    match wrong {
        Some(at) => anyhow::bail!("element {} is {}; expected at most {LARGEST:e}", at / components, values[at]),
        None => Ok(values),
    }
}

fn replace_sparse(file: &File, accessor: &Accessor, form: Form, components: usize, values: &mut [f64]) -> Result<()> {
    let Some(sparse) = &accessor.sparse else { return Ok(()) };
    let Checked::Valid(index_type) = sparse.indices.component_type else { anyhow::bail!("sparse: unknown componentType") };
    let count = usize::try_from(sparse.count.0)?;
    let indices = Form { kind: index_type.0, normalized: false };
    let places = indices.elements(file, sparse.indices.buffer_view, sparse.indices.byte_offset.0, count, 1)?;
    let new = form.elements(file, sparse.values.buffer_view, sparse.values.byte_offset.0, count, components)?;
    for (place, new) in places.iter().zip(new.chunks(components)) {
        let slot = values.chunks_mut(components).nth(*place as usize);
        slot.with_context(|| format!("sparse: index {place} is outside"))?.copy_from_slice(new);
    }
    Ok(())
}

/// How one number is written.
#[derive(Clone, Copy)]
struct Form {
    kind: ComponentType,
    normalized: bool,
}

impl Form {
    fn elements(self, file: &File, view: Index<View>, offset: u64, count: usize, components: usize) -> Result<Vec<f64>> {
        let entry = file.root.buffer_views.get(view.value()).context("no such bufferView")?;
        let bytes = file.buffer(entry.buffer.value())?;
        let size = self.kind.size();
        let stride = entry.byte_stride.map_or(size * components, |stride| stride.0);
        ensure!(stride >= size * components, "byteStride {stride} is less than an element");
        let from = usize::try_from(entry.byte_offset.map_or(0, |offset| offset.0))?;
        let end = from.checked_add(usize::try_from(entry.byte_length.0)?);
        let view = end.and_then(|end| bytes.get(from..end)).context("its bufferView ends after its buffer")?;
        let needed = match count.checked_sub(1) {
            None => Some(0),
            Some(whole) => whole.checked_mul(stride).and_then(|whole| whole.checked_add(size * components)),
        };
        let offset = usize::try_from(offset)?;
        let end = needed.and_then(|needed| needed.checked_add(offset));
        let data = end.and_then(|end| view.get(offset..end)).context("it ends after its bufferView")?;
        let one =
            |element: &[u8]| element[..size * components].chunks(size).map(|number| self.number(number)).collect::<Vec<_>>();
        Ok(data.chunks(stride).flat_map(one).collect())
    }

    fn number(self, bytes: &[u8]) -> f64 {
        let word = bytes.iter().rev().fold(0u32, |word, &byte| word << 8 | u32::from(byte));
        let (value, full) = match self.kind {
            ComponentType::I8 => (f64::from(word as u8 as i8), 127.0),
            ComponentType::U8 => (f64::from(word), 255.0),
            ComponentType::I16 => (f64::from(word as u16 as i16), 32767.0),
            ComponentType::U16 => (f64::from(word), 65535.0),
            ComponentType::U32 => (f64::from(word), f64::from(u32::MAX)),
            ComponentType::F32 => return f64::from(f32::from_bits(word)),
        };
        if self.normalized { (value / full).max(-1.0) } else { value }
    }
}
