//! Damaged text of every importer gives an error or a motion that holds together, never a panic.

use crate::noise::Noise;
use pantin_convert::import::ImportOptions;
use std::path::Path;

const PIECES: [&[u8]; 12] =
    [b"{", b"}", b"\n", b"-", b"1e9", b"nan", b"ROOT", b"End Site", b"\xff", b"0", b" 99999999999999999999 ", b"loop\n"];

fn damage(text: &[u8], noise: &mut Noise) -> Vec<u8> {
    let mut bytes = text.to_vec();
    for _ in 0..1 + noise.below(4) {
        let at = noise.below(bytes.len());
        match noise.below(4) {
            0 => bytes[at] = noise.below(256) as u8,
            1 => bytes.truncate(at.max(1)),
            2 => drop(bytes.drain(at..(at + noise.below(30)).min(bytes.len()))),
            _ => drop(bytes.splice(at..at, PIECES[noise.below(PIECES.len())].iter().copied())),
        }
        if bytes.is_empty() {
            bytes.push(b' ');
        }
    }
    bytes
}

#[test]
fn damaged_files_never_panic() {
    let walk = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/walk.keys")).unwrap();
    let wave = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/wave.proc")).unwrap();
    let bvh = b"HIERARCHY\nROOT hip\n{\nOFFSET 0 9 0\nCHANNELS 2 Yposition Xrotation\nEnd Site\n{\nOFFSET 1 0 0\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.1\n1 2\n3 4\n";
    let mut noise = Noise(1);
    let mut read = 0;
    for (extension, text) in [("keys", walk.as_slice()), ("proc", wave.as_slice()), ("bvh", bvh)] {
        let path = std::env::temp_dir().join(format!("pantin-hostile-{}.{extension}", std::process::id()));
        for _ in 0..400 {
            std::fs::write(&path, damage(text, &mut noise)).unwrap();
            match crate::told::load(&path, &ImportOptions::new()) {
                Ok(read_back) => {
                    let motion = read_back.motion;
                    read += 1;
                    assert_eq!(motion.values.len(), motion.rig.channels());
                    assert!(motion.values.iter().all(|values| values.len() == motion.frames));
                    assert!(motion.values.iter().flatten().all(|value| value.is_finite()));
                    assert!(motion.frame_time > 0.0 && motion.rig.cm_per_unit > 0.0);
                }
                Err(error) => assert!(format!("{error:#}").contains("pantin-hostile"), "{error:#}"),
            }
        }
        std::fs::remove_file(&path).unwrap();
    }
    assert!((30..1170).contains(&read), "{read} of 1200 were read: the damage tests too little");
}
