//! VRML from small worlds of our own: what is read, what is refused, and that neither takes long.

use super::processor_time::within;
use crate::told::Told;
use pantin_convert::edit::Edits;
use pantin_convert::import::Disk;
use pantin_convert::import::ImportOptions;
use pantin_convert::{Memory, Recipe, fk};

fn load_as(world: &str, options: &ImportOptions) -> Result<Told, String> {
    let name = format!("pantin-vrml-{}-{:?}.wrl", std::process::id(), std::thread::current().id());
    let path = std::env::temp_dir().join(name);
    std::fs::write(&path, world).unwrap();
    let read = within(5.0, || crate::told::load(&path, options).map_err(|error| format!("{error:#}")));
    std::fs::remove_file(&path).unwrap();
    read
}

fn load(world: &str) -> Result<Told, String> {
    load_as(world, &ImportOptions::new().cm_per_unit(1.0))
}

/// The world's place of a joint.
fn place(imported: &Told, joint: &str, frame: usize) -> [f64; 3] {
    let motion = &imported.motion;
    let index = motion.rig.joints.iter().position(|entry| entry.name == joint).unwrap_or_else(|| panic!("no {joint}"));
    fk::positions(&motion.rig, &motion.values, frame)[index]
}

fn near(a: [f64; 3], b: [f64; 3]) {
    assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-4), "{a:?} is not {b:?}");
}

const LEG: &str = "#VRML V2.0 utf8
# a leg
DEF T TimeSensor { cycleInterval 2 loop TRUE }
DEF P PositionInterpolator { key [ 0, 1 ] keyValue [ 0 10 0, 4 10 0 ] }
DEF O OrientationInterpolator { key [ 0 0.5, 1 ] keyValue [ 0 0 1 0, 0 0 2 1.5707963, 0 0 1 3.1415927 ] }
DEF S ScalarInterpolator { key [ 0 1 ] keyValue [ 0 0.5 ] }
Group { children [
  DEF hip Transform { children [
    Shape { appearance Appearance { material DEF skin Material { diffuseColor 1 0 0 } } geometry Box { size 1 2 3 } }
    DEF knee Transform { center 0 -5 0 rotation 1 0 0 0 children DEF foot Transform { translation 0 -9 0 scale 2 2 2 } }
  ] }
] }
Script { url \"javascript: { ] \\\" \" eventIn SFBool go eventOut SFTime gone field SFNode it USE hip directOutput TRUE }
WorldInfo { title \"a } title\" info [ \"one\" \"two\" ] }
ROUTE T.fraction_changed TO P.set_fraction
ROUTE T.fraction_changed TO O.set_fraction
ROUTE T.fraction_changed TO S.set_fraction
ROUTE P.value_changed TO hip.set_translation
ROUTE O.value_changed TO knee.rotation
ROUTE S.value_changed TO skin.set_transparency
";

#[test]
fn a_leg_moves_as_its_interpolators_say() {
    let leg = load(LEG).unwrap();
    let motion = &leg.motion;
    let names: Vec<&str> = motion.rig.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["hip", "knee", "foot"]);
    // Keys one second apart are no frames: 30 a second.
    assert_eq!((motion.frames, motion.frame_time), (61, 1.0 / 30.0));
    near(place(&leg, "foot", 0), [0.0, 1.0, 0.0]);
    // Half of the first turn, about the center (0, -5, 0): the foot is 4 below it.
    let side = 4.0 * 0.5f64.sqrt();
    near(place(&leg, "foot", 15), [1.0 + side, 5.0 - side, 0.0]);
    near(place(&leg, "foot", 60), [4.0, 9.0, 0.0]);
    assert_eq!(motion.rig.scalars[0].name, "skin.transparency");
    let transparency = motion.values.last().unwrap();
    assert!((transparency[30] - 0.25).abs() < 1e-12 && (transparency[60] - 0.5).abs() < 1e-12);
    assert!(leg.warnings.iter().all(|warning| !warning.contains("left out")), "{:?}", leg.warnings);
}

#[test]
fn a_scale_that_changes_moves_the_joints_below_and_becomes_scalars() {
    // The knee, turned by a right angle about z, grows from 1 to 3 along its own y.
    let world = LEG
        .replace("DEF S Scalar", "DEF G PositionInterpolator { key [ 0, 1 ] keyValue [ 1 1 1, 1 3 1 ] }\nDEF S Scalar")
        .replace("DEF knee Transform { center 0 -5 0 rotation 1 0 0 0", "DEF knee Transform { rotation 0 0 1 1.57079632679")
        .replace(
            "ROUTE O.value_changed TO knee.rotation",
            "ROUTE T.fraction_changed TO G.set_fraction\nROUTE G.value_changed TO knee.scale",
        );
    let leg = load(&world).unwrap();
    for frame in [0, 15, 60] {
        let part = frame as f64 / 60.0;
        near(place(&leg, "knee", frame), [4.0 * part, 10.0, 0.0]);
        near(place(&leg, "foot", frame), [4.0 * part + 9.0 * (1.0 + 2.0 * part), 10.0, 0.0]);
    }
    let scale = leg.motion.rig.scalars.iter().position(|scalar| scalar.name == "knee.scale.y").unwrap();
    let values = &leg.motion.values[leg.motion.rig.joint_channels() + scale];
    assert!((values[15] - 1.5).abs() < 1e-12 && leg.motion.rig.scalars[scale].full_scale == 3.0);
    assert!(leg.warnings.iter().any(|warning| warning.contains("the scale of `knee` changes")), "{:?}", leg.warnings);
    assert!(leg.error_cm < 1e-9, "{}", leg.error_cm);
    // Who leaves the scale out is not told how.
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("leg.wrl"), &world).unwrap();
    let said = |drop: &str| {
        let recipe = Recipe::new().import(ImportOptions::new().cm_per_unit(1.0)).edits(Edits::new().drop(drop));
        let notes = recipe.edited(&Disk::new(Memory::default()), &folder.path().join("leg.wrl")).unwrap().notes;
        notes.iter().any(|note| note.text.contains("the scale of `knee`"))
    };
    assert!(said("skin.*") && !said("*.scale.*"));
}

#[test]
fn x3d_in_its_classic_encoding_is_the_same() {
    let header = "#X3D V3.2 utf8\nPROFILE Immersive\nCOMPONENT H-Anim:1\nMETA \"title\" \"leg\"\nUNIT length inch 0.0254\n";
    let world = LEG.replace("#VRML V2.0 utf8\n", header).replace("eventIn", "inputOnly").replace("eventOut", "outputOnly");
    let world = world.replace("field SFNode", "initializeOnly SFNode");
    assert_eq!(load(&world).unwrap().motion, load(LEG).unwrap().motion);
}

#[test]
fn h_anim_prototypes_are_joints() {
    let world = "#VRML V2.0 utf8
EXTERNPROTO Elsewhere [ field SFInt32 a ] [ \"else.wrl\" ]
PROTO Joint [ exposedField SFVec3f center 0 0 0 exposedField SFRotation rotation 0 0 1 0 exposedField MFNode children [ ]
  exposedField SFString name \"\" eventIn MFNode addChildren ]
{ Transform { center IS center rotation IS rotation children IS children addChildren IS addChildren } }
PROTO Humanoid [ exposedField MFNode humanoidBody [ ] field MFNode joints [ ] ] { Transform { children IS humanoidBody } }
PROTO Shifted [ exposedField SFVec3f to 0 3 0 field MFNode inside [ ] ] { Transform { translation IS to children IS inside } DEF knee Group { } }
DEF man Humanoid { humanoidBody [
  DEF hip Joint { center 0 2 0 name \"hip\" children [ DEF tip Shifted { inside [ DEF end Transform { translation 1 0 0 } ] } ] } ]
  joints [ USE hip ] }
DEF T TimeSensor { }
DEF O OrientationInterpolator { key [ 0 1 ] keyValue [ 0 0 1 0 0 0 1 1.5707963267948966 ] }
DEF P PositionInterpolator { key [ 0 1 ] keyValue [ 0 3 0 0 5 0 ] }
ROUTE T.fraction_changed TO O.set_fraction ROUTE O.value_changed TO hip.set_rotation
ROUTE T.fraction_changed TO P.set_fraction ROUTE P.value_changed TO tip.set_to
";
    let man = load(world).unwrap();
    near(place(&man, "end", 0), [1.0, 3.0, 0.0]);
    // A quarter turn about (0, 2, 0) takes (1, 5, 0) to (-3, 3, 0).
    near(place(&man, "end", 30), [-3.0, 3.0, 0.0]);
}

#[test]
fn of_several_clocks_the_longest_is_read_and_another_can_be_chosen() {
    let world = format!(
        "{LEG} DEF short TimeSensor {{ cycleInterval 0.5 }} DEF Q PositionInterpolator {{ key [ 0 1 ] keyValue [ 7 0 0 8 0 0 ] }}
         ROUTE short.fraction_changed TO Q.set_fraction ROUTE Q.value_changed TO foot.set_translation
         DEF lost ColorInterpolator {{ key [ 0 ] keyValue [ 1 1 1 ] }}"
    );
    let leg = load(&world).unwrap();
    near(place(&leg, "foot", 0), [0.0, 1.0, 0.0]);
    assert!(leg.warnings.iter().any(|warning| warning.contains("2 time sensors; `T` with 2 s is read")), "{:?}", leg.warnings);
    assert!(leg.warnings.iter().any(|warning| warning.contains("1 interpolators")), "{:?}", leg.warnings);
    for choice in ["short", "1"] {
        let options = ImportOptions::new().animation(choice).cm_per_unit(1.0);
        let short = load_as(&world, &options).unwrap();
        assert_eq!(short.motion.frames, 16);
        near(place(&short, "foot", 15), [8.0, 0.0, 0.0]);
    }
    let options = ImportOptions::new().animation("none");
    assert!(load_as(&world, &options).unwrap_err().contains("the file has 0 (T), 1 (short)"));
}

#[test]
fn four_digits_of_a_rate_are_seen_through() {
    // 25 a second for 45.27 s, with keys rounded as exporters do, in which the fourth digit is most of a distance at the end.
    let (cycle, fps) = (45.27, 25.0);
    let keys: Vec<f64> = (0..=1131).map(|frame| f64::from(frame) / (cycle * fps)).collect();
    let digits = |key: &f64| if *key == 0.0 { "0".into() } else { format!("{key:.*}", (3.0 - key.log10().floor()) as usize) };
    let keys: Vec<String> = keys.iter().map(digits).collect();
    let values: Vec<String> = (0..keys.len()).map(|key| format!("{key} 0 0")).collect();
    let world = format!(
        "#VRML V2.0 utf8\nDEF T TimeSensor {{ cycleInterval {cycle} }} DEF A Transform {{ }}
         DEF P PositionInterpolator {{ key [ {} ] keyValue [ {} ] }}
         ROUTE T.fraction_changed TO P.set_fraction ROUTE P.value_changed TO A.set_translation",
        keys.join(","),
        values.join(",")
    );
    let read = load(&world).unwrap();
    // The cycle of 1,131.75 frames ends between two.
    assert_eq!((read.motion.frame_time, read.motion.frames), (1.0 / fps, 1133));
}

#[test]
fn errors_name_the_line_and_what_was_expected() {
    let cases = [
        ("cycleInterval 2", "cycleInterval -3", "moves anything"),
        (
            "key [ 0, 1 ] keyValue [ 0 10 0, 4 10 0 ]",
            "key [ 0, 1 ] keyValue [ 0 10 0, 4 10 ]",
            ":4: 2 keys of `P` have 5 numbers",
        ),
        ("key [ 0 0.5, 1 ]", "key [ 0 5, 1 ]", ":5: key 2 of `O` is 1, after 5"),
        ("4 10 0 ]", "4 1e300 0 ]", ":4: expected a number of at most 1e9, found `1e300`"),
        ("TO hip.set_translation", "TO hip", "expected `ROUTE node.event TO node.event`"),
        ("children DEF foot", "children USE nobody DEF foot", ":10: USE of `nobody`, which no DEF before it names"),
        ("DEF foot Transform { translation 0 -9 0 scale 2 2 2 }", "[ USE hip ]", "`hip` stands in itself"),
        ("ROUTE T.fraction_changed", "ROUTE Nobody.fraction_changed", "no TimeSensor moves anything"),
        ("Script {", "Script { {", "expected a field, found `{`"),
        ("] }\nScript", "}\nScript", "expected"),
    ];
    for (from, to, expected) in cases {
        assert!(LEG.contains(from), "{from}");
        match load(&LEG.replace(from, to)) {
            Ok(_) => assert_eq!(expected, "moves anything", "{to} is read"),
            Err(error) => assert!(error.contains(expected) && error.contains("pantin-vrml"), "{to}: {error}"),
        }
    }
    assert!(load("#VRML V1.0 ascii\n").unwrap_err().contains("VRML 1.0"));
    assert!(load("\u{1f}\u{8b}").is_err());
}

#[test]
fn every_beginning_of_a_world_ends_in_an_error_or_a_motion() {
    for end in 1..LEG.len() {
        let _ = load(&LEG[..end]);
    }
}

#[test]
fn worlds_that_would_fill_memory_or_stack_are_refused() {
    let deep = format!("#VRML V2.0 utf8\n{}", "Transform { children [ ".repeat(100_000));
    assert!(load(&deep).unwrap_err().contains("nodes in each other"));
    let prototypes = format!("#VRML V2.0 utf8\n{}", "PROTO A [ ] { ".repeat(100_000));
    assert!(load(&prototypes).unwrap_err().contains("nodes in each other"));
    let fields = LEG.replace("center 0 -5 0", &"a 1 ".repeat(100_000));
    assert!(load(&fields).unwrap_err().contains("more than 256 fields"));
    let lists = format!("#VRML V2.0 utf8\nA {{ b {}", "[ ".repeat(100_000));
    assert!(load(&lists).unwrap_err().contains("expected"));
    let mut laughs = format!("{LEG} DEF l0 Group {{ }}");
    for level in 1..60 {
        let below = level - 1;
        laughs += &format!(" DEF l{level} Group {{ children [ USE l{below} USE l{below} ] }}");
    }
    assert!(load(&laughs).unwrap_err().contains("USE makes more than"));
    let mut chain = format!("{LEG} DEF l0 Group {{ }}");
    (1..3000).for_each(|level| chain += &format!(" DEF l{level} Group {{ children USE l{} }}", level - 1));
    assert!(load(&chain).unwrap_err().contains("nodes in each other"));
    let long = LEG.replace("cycleInterval 2", "cycleInterval 999999999");
    assert!(load(&long).unwrap_err().contains("--fps"));
    let loops = "#VRML V2.0 utf8\nPROTO A [ ] { B { } } PROTO B [ ] { A { } } A { children A { } }";
    assert!(load(loops).unwrap_err().contains("the prototype `A` contains itself"));
}

#[test]
fn a_cycle_that_is_no_time_is_named() {
    for (cycle, shown) in [("0", "0"), ("-2", "-2"), ("nan", "no number")] {
        let leg = load(&LEG.replace("cycleInterval 2", &format!("cycleInterval {cycle}"))).unwrap();
        let named = |warning: &String| warning.contains(&format!("`T` (line 3) has the cycleInterval {shown}"));
        assert!(leg.warnings.iter().any(named), "{:?}", leg.warnings);
    }
    assert!(!load(LEG).unwrap().warnings.iter().any(|warning| warning.contains("cycleInterval")));
}

#[test]
fn a_prototype_that_contains_itself_is_named() {
    let with = |prototypes: &str| load(&LEG.replace("# a leg", prototypes)).map(drop);
    for (prototypes, wanted) in [
        ("PROTO Leg [] { Leg { } }", ":2: the prototype `Leg` contains itself"),
        ("PROTO Leg [] {\nTransform { children Leg { } } }", ":3: the prototype `Leg` contains itself"),
        ("PROTO Leg [] {\nGroup { }\nTransform { children [ DEF a Leg { } ] } }", ":4: the prototype `Leg` contains itself"),
        ("PROTO A [] { B { } }\nPROTO B [] { C { } }\nPROTO C [] { A { } }", ":4: the prototype `A` contains itself"),
    ] {
        let said = with(prototypes).unwrap_err();
        assert!(said.contains(wanted), "{prototypes}: {said}");
    }
    with("PROTO A [] { Transform { } }\nPROTO B [] { A { children A { } } }\nB { }").unwrap();
    // A long chain and many nodes take no time.
    let chain: String = (0..20_000).map(|index| format!("PROTO P{index} [] {{ P{} {{ }} }}\n", index + 1)).collect();
    with(&chain).unwrap();
    let deep: String = (0..150).map(|index| format!("PROTO N{index} [] {{ {}", "Group { } ".repeat(300))).collect();
    with(&format!("{deep}{}", "}".repeat(150))).unwrap();
}

/// Joints in the style of the standard: all places in `center`, no translations.
#[test]
fn joints_of_h_anim_are_at_their_centers() {
    let world = "#VRML V2.0 utf8
PROTO Joint [ exposedField SFVec3f center 0 0 0 exposedField SFRotation rotation 0 0 1 0 exposedField MFNode children [ ] exposedField SFVec3f translation 0 0 0 ]
{ Transform { center IS center rotation IS rotation translation IS translation children IS children } }
PROTO Humanoid [ exposedField MFNode humanoidBody [ ] ] { Transform { children IS humanoidBody } }
DEF man Humanoid { humanoidBody [ DEF hip Joint { center 0 2 0 children [ DEF knee Joint { center 0 1 0 children [ DEF ankle Joint { center 0 0.5 0 } ] } ] } ] }
DEF T TimeSensor { cycleInterval 2 }
DEF O OrientationInterpolator { key [ 0, 1 ] keyValue [ 0 0 1 0, 0 0 1 1.57079632679 ] }
ROUTE T.fraction_changed TO O.set_fraction ROUTE O.value_changed TO knee.set_rotation";
    let man = load(world).unwrap();
    let last = man.motion.frames - 1;
    near(place(&man, "hip", last), [0.0, 2.0, 0.0]);
    near(place(&man, "knee", last), [0.0, 1.0, 0.0]);
    near(place(&man, "ankle", 0), [0.0, 0.5, 0.0]);
    near(place(&man, "ankle", last), [0.5, 1.0, 0.0]);
}

/// A cycle is a cycle, and what does not fit is named.
#[test]
fn a_cycle_is_whole_and_what_is_odd_in_it_is_named() {
    let world = |keys: &str, place: &str| {
        format!(
            "#VRML V2.0 utf8\nDEF A Transform {{ translation {place} children [ DEF B Transform {{ translation 0 1 0 }} ] }}
DEF T TimeSensor {{ cycleInterval 4 loop TRUE }}
DEF P PositionInterpolator {{ key [{keys}] keyValue [0 0 0, 0 1 0, 0 0 0] }}
ROUTE T.fraction_changed TO P.set_fraction ROUTE P.value_changed TO A.set_translation"
        )
    };
    let held = load(&world("0.25 0.5 0.75", "0 0 0")).unwrap();
    assert_eq!((held.motion.frames, held.motion.frame_time), (121, 1.0 / 30.0));
    let odd = load(&world("0.25 0.5 1.75", "2 1")).unwrap();
    assert_eq!(odd.motion.frames, 121);
    for part in
        ["keys outside the cycle are never reached, as one at 1.750", "have a translation or the like without its 3 numbers"]
    {
        assert!(odd.warnings.iter().any(|warning| warning.contains(part)), "{part}: {:?}", odd.warnings);
    }
}
