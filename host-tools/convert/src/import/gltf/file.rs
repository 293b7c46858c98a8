//! The container: JSON, and the buffers it names, from a .glb, from data URIs, or from files beside it.

use crate::import::Request;
pub(crate) use crate::import::one_line;
use crate::memory::Memory;
use crate::note::{Note, NoteKind};
use anyhow::{Context, Result, anyhow, bail};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use gltf::json::accessor::Accessor;
use gltf::json::animation::{Animation, Channel};
use gltf::json::validation::{Error, Validate};
use gltf::json::{Index, Path as JsonPath, Root};
use std::cell::{Cell, OnceCell};
use std::path::{Component, Path, PathBuf};

/// Parts of the JSON that motion depends on: what is wrong elsewhere (materials, say) does not matter.
const NEEDED: [&str; 8] = ["nodes", "scene", "skins", "animations", "accessors", "bufferViews", "buffers", "asset"];

/// Length of the head of a .glb.
const GLB_HEAD: usize = 12;

/// Extensions that may be required and that change nothing that is read here, or that are read: materials, textures, lights,
/// integers as coordinates, an avatar's description. Compressed triangles do not matter to a motion; a mesh with them is refused
/// where it is read.
const HARMLESS: [&str; 14] = [
    "KHR_materials_*",
    "KHR_texture_*",
    "KHR_lights_*",
    "KHR_xmp*",
    "KHR_mesh_quantization",
    "KHR_techniques_webgl",
    COMPRESSED_TRIANGLES,
    "EXT_texture_*",
    "EXT_lights_*",
    "MSFT_texture_*",
    "VRM",
    "VRMC_vrm",
    "VRMC_vrm_animation",
    "VRMC_materials_*",
];

/// The extension that keeps the triangles of a mesh, and the numbers of its points, in a bit stream of its own.
pub const COMPRESSED_TRIANGLES: &str = "KHR_draco_mesh_compression";

/// A glTF file; buffers are read when they are first asked for.
pub struct File<'a> {
    /// The JSON, its indices checked.
    pub root: Root,
    /// What is odd about the container.
    pub notes: Vec<Note>,
    path: PathBuf,
    request: &'a Request<'a>,
    bin: Option<Vec<u8>>,
    buffers: Vec<OnceCell<Vec<u8>>>,
    /// Bytes of all buffers that were read.
    held: Cell<u64>,
}

impl<'a> File<'a> {
    /// Opens `bytes`, the content of `path` among `files`.
    pub fn open(path: &Path, bytes: &[u8], request: &'a Request<'a>) -> Result<File<'a>> {
        let place = |message: String| anyhow!("{}: {}", path.display(), one_line(&message));
        let mut notes = Vec::new();
        let (json, bin) = if bytes.starts_with(b"glTF") {
            let length =
                bytes.get(8..GLB_HEAD).map(|field| u32::from_le_bytes([field[0], field[1], field[2], field[3]]) as usize);
            let Some(whole) = length.filter(|&length| length >= GLB_HEAD).and_then(|length| bytes.get(..length)) else {
                return Err(place("the file is shorter than its head says; expected a whole .glb".into()));
            };
            if bytes.len() > whole.len() {
                let (behind, length) = (bytes.len() - whole.len(), whole.len());
                let text = format!("{behind} bytes stand after the {length} that the head of the .glb states; left out");
                notes.push(Note::warning(NoteKind::Unread, text));
            }
            let glb = gltf::Glb::from_slice(whole).map_err(|error| place(format!("not a .glb of version 2: {error}")))?;
            (glb.json.into_owned(), glb.bin.map(|bin| bin.into_owned()))
        } else {
            (bytes.to_vec(), None)
        };
        let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&json);
        let root: Root = gltf::json::deserialize::from_slice(json).map_err(|error| place(format!("glTF's JSON: {error}")))?;
        if let Some(message) = unknown_version(&root).or_else(|| unknown_extension(&root)).or_else(|| missing_accessor(&root)) {
            return Err(place(message));
        }
        let mut wrong = None;
        root.validate(&root, JsonPath::new, &mut |at, error| {
            let at = at().to_string();
            // The numbers of compressed points stand in no view: where a mesh is read, it is refused.
            let compressed = error == Error::Missing && at.ends_with(".bufferView") && has_compressed_triangles(&root);
            if wrong.is_none() && !compressed && NEEDED.iter().any(|part| at.starts_with(part)) {
                wrong = Some(format!("{at}: {error}"));
            }
        });
        match wrong.or_else(|| missing_node(&root)) {
            Some(message) => Err(place(message)),
            None => Ok(File {
                buffers: vec![OnceCell::new(); root.buffers.len()],
                root,
                notes,
                path: path.into(),
                request,
                bin,
                held: Cell::new(0),
            }),
        }
    }

    /// `path: where: message`; `at` is a JSON path.
    pub fn error(&self, at: &str, message: impl std::fmt::Display) -> anyhow::Error {
        anyhow!("{}: {message}", self.place(at))
    }

    /// `path: where`; `at` is a JSON path.
    pub fn place(&self, at: &str) -> String {
        format!("{}: {at}", self.path.display())
    }

    /// The memory that the motion may take.
    pub fn memory(&self) -> Memory {
        self.request.memory
    }

    /// Bytes of a buffer.
    pub fn buffer(&self, index: usize) -> Result<&[u8]> {
        let at = format!("buffers[{index}]");
        let Some(cell) = self.buffers.get(index) else { bail!(self.error(&at, "no such buffer")) };
        if let Some(bytes) = cell.get() {
            return Ok(bytes);
        }
        let bytes = self.read_buffer(index).with_context(|| self.place(&at))?;
        let expected = self.root.buffers[index].byte_length.0;
        if (bytes.len() as u64) < expected {
            bail!(self.error(&at, format!("{} bytes; expected byteLength, {expected}", bytes.len())));
        }
        // Any number of buffers may name one file.
        self.held.set(self.held.get() + bytes.len() as u64);
        self.memory().check_bytes_held(self.held.get()).with_context(|| self.place(&at))?;
        Ok(cell.get_or_init(|| bytes))
    }

    fn read_buffer(&self, index: usize) -> Result<Vec<u8>> {
        let Some(uri) = &self.root.buffers[index].uri else {
            let bin = if index == 0 { self.bin.clone() } else { None };
            return bin.ok_or_else(|| anyhow!("neither a uri nor a binary chunk holds its bytes"));
        };
        if let Some(data) = uri.strip_prefix("data:") {
            let Some((_, data)) = data.split_once(";base64,") else { bail!("expected base64 in the data URI") };
            return STANDARD.decode(data.trim_end()).map_err(|error| anyhow!("the data URI is no base64: {error}"));
        }
        let Some(beside) = self.beside(uri) else {
            bail!("uri `{}`: expected a data URI or the name of a file beside this one", one_line(uri));
        };
        self.request.read_named(&beside)
    }

    /// The file that a URI names, if it lies beside this one.
    fn beside(&self, uri: &str) -> Option<PathBuf> {
        let name = percent_decoded(uri);
        let relative = Path::new(&name);
        let inside = relative.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        (inside && !uri.contains("://")).then(|| self.path.with_file_name("").join(relative))
    }

    /// The files beside this one that hold its buffers.
    pub fn external_buffers(&self) -> Vec<PathBuf> {
        let uris = self.root.buffers.iter().filter_map(|buffer| buffer.uri.as_deref());
        uris.filter(|uri| !uri.starts_with("data:")).filter_map(|uri| self.beside(uri)).collect()
    }
}

/// Versions are MAJOR.MINOR; files of a later minor version can be read unless they state that they cannot.
fn unknown_version(root: &Root) -> Option<String> {
    let parts = |version: &str| {
        let (major, minor) = version.split_once('.')?;
        Some((major.parse::<u32>().ok()?, minor.parse::<u32>().ok()?))
    };
    let (version, least) = (&root.asset.version, &root.asset.min_version);
    if parts(version).is_none_or(|(major, _)| major != 2) {
        return Some(format!("asset.version is `{}`; glTF 2.0 is read", shortened(version)));
    }
    let least = least.as_ref().filter(|least| parts(least).is_none_or(|least| least > (2, 0)))?;
    Some(format!("asset.minVersion is `{}`; glTF 2.0 is read", shortened(least)))
}

/// An extension that the file requires and that could change what is read here.
fn unknown_extension(root: &Root) -> Option<String> {
    let harmless = |name: &str| {
        HARMLESS.iter().any(|known| known.strip_suffix('*').map_or(name == *known, |prefix| name.starts_with(prefix)))
    };
    let name = root.extensions_required.iter().find(|name| !harmless(name))?;
    let way = if name.ends_with("_meshopt_compression") { ": write the file without compression" } else { "" };
    Some(format!("extensionsRequired: `{}`, which is not read here{way}", shortened(name)))
}

/// Whether meshes of the file can be compressed.
pub fn has_compressed_triangles(root: &Root) -> bool {
    root.extensions_used.iter().any(|name| name == COMPRESSED_TRIANGLES)
}

/// A word of the file as an error quotes it.
fn shortened(word: &str) -> String {
    const LONGEST: usize = 40;
    word.chars().take(LONGEST).collect()
}

/// An accessor that a mesh names and that is not there: the gltf crate looks into it without asking.
fn missing_accessor(root: &Root) -> Option<String> {
    let missing = |accessor: &Index<Accessor>| accessor.value() >= root.accessors.len();
    let mesh = root.meshes.iter().position(|mesh| mesh.primitives.iter().any(|part| part.attributes.values().any(missing)))?;
    Some(format!("meshes[{mesh}]: no such accessor"))
}

/// A node that a channel names and that is not there: the gltf crate does not look into channels.
fn missing_node(root: &Root) -> Option<String> {
    let of_animation = |(number, animation): (usize, &Animation)| {
        let missing = |channel: &Channel| channel.target.node.value() >= root.nodes.len();
        let channel = animation.channels.iter().position(missing)?;
        Some(format!("animations[{number}].channels[{channel}].target.node: no such node"))
    };
    root.animations.iter().enumerate().find_map(of_animation)
}

fn percent_decoded(uri: &str) -> String {
    let mut out = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        let code = match tail {
            [a, b, ..] if *first == b'%' => std::str::from_utf8(&[*a, *b]).ok().and_then(|hex| u8::from_str_radix(hex, 16).ok()),
            _ => None,
        };
        out.push(code.unwrap_or(*first));
        rest = if code.is_some() { &tail[2..] } else { tail };
    }
    String::from_utf8_lossy(&out).into_owned()
}

#[cfg(test)]
mod tests {
    use super::percent_decoded;

    #[test]
    fn percent_signs_are_decoded_where_they_are_codes() {
        assert_eq!(percent_decoded("a%20b%C3%A4%2"), "a bä%2");
    }
}
