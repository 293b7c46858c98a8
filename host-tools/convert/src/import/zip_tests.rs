//! Tests of motions in archives.

use super::*;
use crate::import::{InMemory, import, list as list_of};
use ::zip::write::SimpleFileOptions;
use ::zip::{CompressionMethod, ZipWriter};
use std::io::Write;

fn bvh(frames: usize) -> String {
    let head = "HIERARCHY ROOT hips { OFFSET 0 0 0 CHANNELS 3 Xrotation Yrotation Zrotation End Site { OFFSET 0 100 0 } } MOTION";
    let rows: Vec<String> = (0..frames).map(|frame| format!("{frame} 0 0\n")).collect();
    format!("{head} Frames: {frames} Frame Time: 0.04\n{}", rows.concat())
}

const ASF: &str = ":version 1.10\n:units\n mass 1.0\n length 1.0\n angle deg\n:root\n order TX TY TZ RX RY RZ\n axis XYZ\n position 0 0 0\n \
                   orientation 0 0 0\n:bonedata\n begin\n id 1\n name chest\n direction 0 1 0\n length 10\n axis 0 0 0 XYZ\n dof rx\n end\n:hierarchy\n \
                   begin\n root chest\n end\n";
const AMC: &str = ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\nchest 1\n2\nroot 0 0 0 0 0 0\nchest 2\n";

fn packed(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (number, (name, bytes)) in files.iter().enumerate() {
        let method = if number % 2 == 0 { CompressionMethod::Deflated } else { CompressionMethod::Stored };
        writer.start_file(*name, SimpleFileOptions::default().compression_method(method)).unwrap();
        writer.write_all(bytes).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

fn unpacked(archive: &[u8], options: &ImportOptions) -> Result<Imported, Error> {
    import(&InMemory::new().with("captures.zip", archive), Path::new("captures.zip"), options)
}

fn refused(archive: &[u8], options: &ImportOptions) -> String {
    unpacked(archive, options).unwrap_err().to_string()
}

/// Changes 2 or 4 bytes of every file's header in the directory, and of its own header if `own` is where they stand there.
fn with_headers(archive: &[u8], directory: usize, own: Option<usize>, bytes: &[u8]) -> Vec<u8> {
    let mut out = archive.to_vec();
    for at in 0..archive.len() - 3 {
        let field = match &archive[at..at + 4] {
            b"PK\x01\x02" => Some(directory),
            b"PK\x03\x04" => own,
            _ => None,
        };
        if let Some(field) = field {
            out[at + field..at + field + bytes.len()].copy_from_slice(bytes);
        }
    }
    out
}

#[test]
fn a_motion_in_an_archive_is_the_motion_beside_it() {
    let text = bvh(3);
    let archive = packed(&[("__MACOSX/._walk.bvh", b"\0\x05"), ("readme.txt", b"a walk"), ("a/Walk.BVH", text.as_bytes())]);
    let options = ImportOptions::new().cm_per_unit(2.0);
    let inside = unpacked(&archive, &options).unwrap();
    let plain = import(&InMemory::new().with("walk.bvh", text.as_bytes()), Path::new("walk.bvh"), &options).unwrap();
    assert_eq!(inside.motion.values, plain.motion.values);
    assert_eq!(inside.motion.rig.cm_per_unit, 2.0);
    assert_eq!(inside.notes, plain.notes);
    assert_eq!(inside.motion.origin.bytes, archive.len() as u64);
}

#[test]
fn skeletons_and_buffers_lie_in_the_archive() {
    let archive = packed(&[("02/02_01.amc", AMC.as_bytes()), ("02/02.asf", ASF.as_bytes()), ("03/03.asf", b"nonsense")]);
    assert_eq!(unpacked(&archive, &ImportOptions::new()).unwrap().motion.frames, 2);
    let alone = packed(&[("02_01.amc", AMC.as_bytes())]);
    assert!(refused(&alone, &ImportOptions::new()).starts_with("captures.zip: 02_01.amc:1: no skeleton beside it"));
    // What the user names may lie beside the archive.
    let files = InMemory::new().with("captures.zip", &*alone).with("mine.asf", ASF.as_bytes());
    let given = import(&files, Path::new("captures.zip"), &ImportOptions::new().skeleton("mine.asf")).unwrap();
    assert_eq!(given.motion.frames, 2);
}

#[cfg(feature = "gltf")]
#[test]
fn a_gltf_reads_its_buffer_from_the_archive_and_nowhere_else() {
    let json = r#"{"asset": {"version": "2.0"}, "nodes": [{"name": "hips"}], "scenes": [{"nodes": [0]}], "scene": 0,
        "buffers": [{"uri": "parts/move.bin", "byteLength": 32}],
        "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                      {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"}],
        "animations": [{"name": "jump", "samplers": [{"input": 0, "output": 1}],
                        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]}"#;
    let numbers = [0.0f32, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bin: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    let archive = packed(&[("scene/jump.gltf", json.as_bytes()), ("scene/parts/move.bin", &bin)]);
    assert!(unpacked(&archive, &ImportOptions::new().fps(30.0)).is_ok());
    // The only motion's animations are those of the archive.
    let options = ImportOptions::new().fps(30.0).animation("jump");
    assert!(unpacked(&archive, &options).is_ok());
    let files = InMemory::new().with("captures.zip", &*archive);
    let entries = list_of(&files, Path::new("captures.zip"), &ImportOptions::new()).unwrap();
    assert_eq!(entries[0].name.as_deref(), Some("jump"));
    let alone = packed(&[("scene/jump.gltf", json.as_bytes())]);
    let files = InMemory::new().with("captures.zip", &*alone).with("scene/parts/move.bin", &*bin).with("parts/move.bin", &*bin);
    let error = import(&files, Path::new("captures.zip"), &options).unwrap_err().to_string();
    assert!(error.starts_with("captures.zip: ") && error.contains("not in the archive"), "{error}");
}

#[test]
fn of_several_motions_the_user_chooses_one() {
    let texts = [bvh(2), bvh(3), bvh(4)];
    let [run, walk, wave] = [0, 1, 2].map(|index| texts[index].as_bytes());
    let archive = packed(&[("labels.csv", b"time,label\n0,1\n"), ("z/wave.bvh", wave), ("walk.bvh", walk), ("a/run.bvh", run)]);
    let first = unpacked(&archive, &ImportOptions::new()).unwrap();
    assert_eq!(first.motion.frames, 2);
    let note = first.notes.iter().find(|note| note.kind == NoteKind::Animation).unwrap();
    assert_eq!(note.to_string(), "motion 0 (a/run.bvh) of the archive's 4");
    assert_eq!((note.is_warning(), note.remedy), (true, Some(Remedy::ChooseAnimation)));
    for (name, frames) in [("walk", 3), ("WAVE.bvh", 4), ("z/wave.bvh", 4), ("1", 3), ("a/run.bvh", 2)] {
        let chosen = unpacked(&archive, &ImportOptions::new().animation(name)).unwrap();
        assert_eq!((chosen.motion.frames, chosen.notes.len()), (frames, first.notes.len() - 1), "{name}");
    }
    let error = refused(&archive, &ImportOptions::new().animation("jump"));
    let names = "0 (a/run.bvh), 1 (walk.bvh), 2 (z/wave.bvh), 3 (labels.csv)";
    assert_eq!(error, format!("captures.zip: animation: no motion `jump` in the archive, which has {names}"));
    let files = InMemory::new().with("captures.zip", archive);
    let entries = list_of(&files, Path::new("captures.zip"), &ImportOptions::new()).unwrap();
    let names: Vec<(&str, usize)> = entries.iter().map(|entry| (entry.name.as_deref().unwrap(), entry.frames)).collect();
    assert_eq!(names[..3], [("a/run.bvh", 2), ("walk.bvh", 3), ("z/wave.bvh", 4)]);
}

#[test]
fn what_is_no_motion_is_refused_with_the_reason() {
    let none = ImportOptions::new();
    assert!(
        refused(&packed(&[("readme.txt", b"a")]), &none).starts_with("captures.zip: no motion in it; expected BVH (.bvh) or ")
    );
    let nested = packed(&[("deep/walks.zip", &packed(&[("walk.bvh", bvh(2).as_bytes())]))]);
    assert_eq!(refused(&nested, &none), "captures.zip: no motion in it but another archive, `deep/walks.zip`; unpack it first");
    let archive = packed(&[("walk.bvh", bvh(2).as_bytes())]);
    let encrypted = with_headers(&archive, 8, Some(6), &[1, 0]);
    assert_eq!(refused(&encrypted, &none), "captures.zip: walk.bvh: encrypted; unpack the archive with its password first");
    let method = with_headers(&archive, 10, Some(8), &[12, 0]);
    assert!(refused(&method, &none).starts_with("captures.zip: walk.bvh: packed by a method that is not read"));
    let damaged = with_headers(&archive, 16, None, &[1, 2, 3, 4]);
    assert!(refused(&damaged, &none).starts_with("captures.zip: walk.bvh: the archive is damaged: "));
    assert!(refused(&archive[..archive.len() - 30], &none).starts_with("captures.zip: the archive is damaged: "));
    let wrong = packed(&[("walk.bvh", b"HIERARCHY ROOT {")]);
    assert!(refused(&wrong, &none).starts_with("captures.zip: walk.bvh:1"));
    let lost = packed(&[("run.bvh", bvh(2).as_bytes())]);
    assert!(refused(&lost, &none.skeleton("x.asf")).contains("only an .amc takes one"));
}

#[test]
fn archives_that_unpack_to_too_much_are_refused() {
    let archive = packed(&[("walk.bvh", &[bvh(2).as_bytes(), &vec![b'\n'; 1 << 22]].concat())]);
    assert!(archive.len() < 1 << 15);
    let little = ImportOptions::new().memory(Memory::new(1 << 20));
    let error = unpacked(&archive, &little).unwrap_err();
    assert!(matches!(error, Error::Memory(_)), "{error:?}");
    // More bytes than the directory states.
    let liar = with_headers(&archive, 24, None, &100u32.to_le_bytes());
    assert!(refused(&liar, &little).contains("it states 100 bytes"), "{}", refused(&liar, &little));
    // Many motions, each within the limit.
    let many: Vec<String> = (0..8).map(|number| format!("{number}.bvh")).collect();
    let text = vec![b'\n'; 1 << 18];
    let many = packed(&many.iter().map(|name| (name.as_str(), &text[..])).collect::<Vec<_>>());
    let listed = list_of(&InMemory::new().with("captures.zip", many), Path::new("captures.zip"), &little).unwrap_err();
    assert!(matches!(listed, Error::Memory(_)), "{listed:?}");
}

#[test]
fn names_do_not_lead_out_of_the_archive() {
    let paths =
        ["../../etc/a.bvh", "/etc/a.bvh", "C:\\etc\\a.bvh", "etc/./b/../a.bvh"].map(|path| inside(Path::new(path)).unwrap());
    assert!(paths.iter().all(|path| path == Path::new("etc/a.bvh")), "{paths:?}");
    assert_eq!(inside(Path::new("../.")), None);
    let archive = packed(&[("../../walk.bvh", bvh(2).as_bytes())]);
    assert_eq!(unpacked(&archive, &ImportOptions::new()).unwrap().motion.frames, 2);
}

#[test]
fn damaged_archives_never_panic() {
    let archive = packed(&[("a/run.bvh", bvh(3).as_bytes()), ("b/02.amc", AMC.as_bytes()), ("b/02.asf", ASF.as_bytes())]);
    let options = ImportOptions::new().memory(Memory::new(1 << 22));
    let read = |bytes: &[u8]| {
        let files = InMemory::new().with("captures.zip", bytes);
        for options in [options.clone(), options.clone().animation("1")] {
            let _ = import(&files, Path::new("captures.zip"), &options);
        }
        let _ = list_of(&files, Path::new("captures.zip"), &options);
    };
    (0..archive.len()).for_each(|len| read(&archive[..len]));
    for at in 0..archive.len() {
        for flip in [1, 0x80, 0xff] {
            let mut bytes = archive.clone();
            bytes[at] ^= flip;
            read(&bytes);
        }
    }
}
