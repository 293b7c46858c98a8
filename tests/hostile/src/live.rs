//! Bodies that are captured now: nothing that a sender says panics or ends a session, and a figure that hears nothing more comes to rest.

use std::net::SocketAddr;
use std::path::Path;

use pantin::Clip;
use pantin_convert::expand::expand;
use pantin_convert::export::bvh;
use pantin_line::stream::body::{Body, EASE_SECONDS, HELD_SECONDS};

/// The clip of the receiver's figure.
const WALK: &[u8] = include_bytes!("../../vectors/walk.ptn");
/// Bytes of which one input may consist.
const MOST_BYTES: usize = 8192;
/// Bytes of a stream that come between two frames.
const FRAME_BYTES: usize = 256;

/// VMC's bones whose rotations are the first inputs.
pub const BONES: [&str; 4] = ["Hips", "Spine", "LeftUpperArm", "RightLowerLeg"];

/// Datagrams, each behind its length of two bytes: bones alone, and in a bundle with the root.
pub fn datagrams() -> Vec<Vec<u8>> {
    let bones = BONES.map(|name| message("/VMC/Ext/Bone/Pos", name));
    let root = message("/VMC/Ext/Root/Pos", "root");
    let mut bundle = b"#bundle\0\0\0\0\0\0\0\0\x01".to_vec();
    for element in bones.iter().chain([&root]) {
        bundle.extend((element.len() as u32).to_be_bytes());
        bundle.extend(element);
    }
    let framed = |datagrams: &[Vec<u8>]| -> Vec<u8> {
        datagrams
            .iter()
            .flat_map(|datagram| (datagram.len() as u16).to_be_bytes().into_iter().chain(datagram.iter().copied()))
            .collect()
    };
    vec![framed(&bones), framed(&[bundle])]
}

/// A name with a place and a rotation about x by 60 degrees.
fn message(address: &str, name: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    for text in [address, ",sfffffff", name] {
        bytes.extend(text.bytes());
        bytes.resize((bytes.len() + 1).next_multiple_of(4), 0);
    }
    bytes.extend([0.1f32, 0.9, 0.0, 0.5, 0.0, 0.0, 0.866_025_4].into_iter().flat_map(f32::to_be_bytes));
    bytes
}

/// The receiver's own clip as a stream.
pub fn streams() -> Vec<Vec<u8>> {
    let Some(motion) = Clip::new_checked(WALK).ok().and_then(|clip| expand(&clip).ok()) else { return vec![] };
    let mut text = Vec::new();
    if bvh::write(&motion, bvh::Columns::ThreeRotations, &mut text).is_err() {
        return vec![];
    }
    // Its header and its first rows, whole.
    let end = text.iter().take(MOST_BYTES).rposition(|byte| *byte == b'\n').unwrap_or(0);
    text.truncate(end + 1);
    vec![text]
}

/// Takes datagrams, one a frame. Returns whether a pose came and none was left out.
pub fn vmc(bytes: &[u8]) -> bool {
    let Some(mut body) = Clip::new_checked(WALK).ok().and_then(|clip| Body::vmc(&clip).ok()) else { return false };
    let sender = SocketAddr::from(([127, 0, 0, 1], 39_539));
    let mut rest = bytes.get(..MOST_BYTES).unwrap_or(bytes);
    while let Some((&len, after)) = rest.split_first_chunk::<2>() {
        let (datagram, after) = after.split_at(usize::from(u16::from_be_bytes(len)).min(after.len()));
        body.receive(sender, datagram);
        show(&mut body);
        rest = after;
    }
    comes_to_rest(&mut body);
    body.posing_has_begun() && body.left_out() == 0
}

/// Takes a BVH stream in parts, one a frame. Returns whether a pose came and none was left out.
pub fn bvh(bytes: &[u8]) -> bool {
    let Some(mut body) = Clip::new_checked(WALK).ok().and_then(|clip| Body::bvh(&clip, Path::new("-")).ok()) else {
        return false;
    };
    for part in bytes.get(..MOST_BYTES).unwrap_or(bytes).chunks(FRAME_BYTES) {
        if body.push(part).is_err() {
            return false;
        }
        show(&mut body);
    }
    if body.end().is_err() {
        return false;
    }
    while body.has_row() {
        show(&mut body);
    }
    comes_to_rest(&mut body);
    body.posing_has_begun() && body.left_out() == 0
}

fn show(body: &mut Body) -> Vec<i32> {
    let pose = body.pose();
    assert_eq!(pose.len(), body.posing().raw().len());
    pose
}

/// A figure whose sender is silent shows the first frame of its clip again.
fn comes_to_rest(body: &mut Body) {
    let clip = Clip::new_checked(WALK).expect("it was opened before");
    let first = pantin_convert::Posing::new(&clip).expect("it was posed before").raw();
    let frames = (HELD_SECONDS + EASE_SECONDS) * 1e9 / f64::from(clip.frame_time_ns());
    let mut pose = show(body);
    for _ in 0..frames.ceil() as u32 {
        pose = show(body);
    }
    assert_eq!(pose, first);
}
