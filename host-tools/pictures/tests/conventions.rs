//! The solid figure finds a person's parts by the names of every convention, and draws the same person whatever the joints are called.

use embedded_graphics::pixelcolor::Gray4;
use pantin::{ChannelState, Clip, Player};
use pantin_convert::import::{self, ImportOptions, InMemory};
use pantin_convert::{Length, Options, convert};
use pantin_figure::solid::{Build, Look, SolidFigure};
use pantin_figure::surface::{Framebuffer, Gray4Rows};
use pantin_figure::{Canvas, View};

/// Names of our walk's joints: hips, spine, chest, neck, head, then of the left side shoulder, upper arm, forearm, hand, thigh, shin, foot, toes.
/// `{S}`, `{s}` and `{side}` are the side: L, l and Left, or R, r and Right.
const CONVENTIONS: [(&str, &str); 8] = [
    (
        "Pantin",
        "hips spine chest neck head {lower}-shoulder {lower}-upper-arm \
         {lower}-forearm {lower}-hand {lower}-thigh {lower}-shin {lower}-foot {lower}-toes",
    ),
    (
        "CMU",
        "Hips LowerBack Spine1 Neck Head {side}Shoulder {side}Arm \
         {side}ForeArm {side}Hand {side}UpLeg {side}Leg {side}Foot {side}ToeBase",
    ),
    (
        "Acclaim",
        "hip lowerback thorax lowerneck head {s}clavicle {s}humerus \
         {s}radius {s}wrist {s}femur {s}tibia {s}foot {s}toes",
    ),
    (
        "Bandai",
        "Hips Spine Chest Neck Head Shoulder_{S} UpperArm_{S} \
         LowerArm_{S} Hand_{S} UpperLeg_{S} LowerLeg_{S} Foot_{S} Toes_{S}",
    ),
    (
        "Mixamo",
        "mixamorig:Hips mixamorig:Spine mixamorig:Spine2 mixamorig:Neck mixamorig:Head mixamorig:{side}Shoulder mixamorig:{side}Arm \
         mixamorig:{side}ForeArm mixamorig:{side}Hand mixamorig:{side}UpLeg mixamorig:{side}Leg mixamorig:{side}Foot mixamorig:{side}ToeBase",
    ),
    (
        "VRM",
        "J_Bip_C_Hips J_Bip_C_Spine J_Bip_C_Chest J_Bip_C_Neck J_Bip_C_Head J_Bip_{S}_Shoulder J_Bip_{S}_UpperArm \
         J_Bip_{S}_LowerArm J_Bip_{S}_Hand J_Bip_{S}_UpperLeg J_Bip_{S}_LowerLeg J_Bip_{S}_Foot J_Bip_{S}_ToeBase",
    ),
    (
        "Rigify",
        "spine spine.001 spine.002 spine.004 head shoulder.{S} upper_arm.{S} \
         forearm.{S} hand.{S} thigh.{S} shin.{S} foot.{S} toe.{S}",
    ),
    (
        "Unreal",
        "pelvis spine_01 spine_03 neck_01 head clavicle_{s} upperarm_{s} \
         lowerarm_{s} hand_{s} thigh_{s} calf_{s} foot_{s} ball_{s}",
    ),
];

/// Our walk with other names.
fn renamed(names: &str) -> Vec<u8> {
    let walk = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../motions/walk.keys")).unwrap();
    let files = InMemory::new().with("walk.keys", walk);
    let mut motion = import::import(&files, "walk.keys".as_ref(), &ImportOptions::new()).unwrap().motion;
    let [own, names] = [CONVENTIONS[0].1, names].map(|names| names.split_whitespace().collect::<Vec<_>>());
    let sides = [["L", "l", "Left", "left"], ["R", "r", "Right", "right"]];
    let of_side = |name: &str, [capital, letter, word, lower]: [&str; 4]| {
        name.replace("{S}", capital).replace("{s}", letter).replace("{side}", word).replace("{lower}", lower)
    };
    let mut done = 0;
    for joint in &mut motion.rig.joints {
        let place = |side| own.iter().position(|name| of_side(name, side) == joint.name);
        let found = sides.into_iter().find_map(|side| Some((place(side)?, side)));
        if let Some((index, side)) = found {
            joint.name = of_side(names[index], side);
            done += 1;
        }
    }
    assert_eq!(done, 5 + 2 * 8);
    convert(&motion, &Options::new().max_error(Length::cm(1.0)), &mut |_| ()).unwrap().clip
}

/// A few pictures of a clip: the pixels that are not dark, and their greys.
fn pictures(clip: &[u8]) -> Vec<Vec<(usize, u8)>> {
    let clip = Clip::new_checked(clip).unwrap();
    let mut states = vec![ChannelState::NEW; clip.moving()];
    let mut values = vec![0; clip.rig().channels()];
    let mut player = Player::new(clip, &mut states, &mut values).unwrap();
    let canvas = Canvas { width: 128, height: 64 };
    let mut figure = SolidFigure::<48>::of_clip(&mut player, canvas, View::default(), Look::DEFAULT).unwrap();
    assert_eq!(figure.build(), Build::Person);
    let picture = |frame| {
        player.seek(frame);
        figure.set_pose(player.pose()).unwrap();
        let mut framebuffer = Framebuffer::<Gray4Rows<128, 64, 1024>>::new();
        figure.draw_on(&mut framebuffer, true);
        let greys = (0..128 * 64).map(|index| (index, luma(framebuffer.pixel(index % 128, index / 128))));
        greys.filter(|(_, grey)| *grey > 0).collect()
    };
    [0, 40, 80, 120].map(picture).into()
}

fn luma(grey: Gray4) -> u8 {
    use embedded_graphics::pixelcolor::GrayColor;
    grey.luma()
}

#[test]
fn the_same_person_is_drawn_whatever_its_joints_are_called() {
    let own = pictures(&renamed(CONVENTIONS[0].1));
    assert!(own.iter().all(|picture| picture.len() > 300));
    for (convention, names) in &CONVENTIONS[1..] {
        assert_eq!(pictures(&renamed(names)), own, "{convention}");
    }
}
