//! FBX from a small text file of our own: what is read, what is refused, and that neither takes long.

use crate::told::Told;
use pantin_convert::fk;
use pantin_convert::import::ImportOptions;

/// In metres and z up: a hip that a pre-rotation turns a quarter about x, a knee and a foot below it, a camera, a face with a weight; one
/// stack of a second that turns the hip a quarter about x and shows half of the smile, and one that does nothing.
const LEG: &str = include_str!("../data/leg.fbx");

fn load_as(file: &[u8], options: &ImportOptions) -> Result<Told, String> {
    let name = format!("pantin-fbx-{}-{:?}.fbx", std::process::id(), std::thread::current().id());
    let path = std::env::temp_dir().join(name);
    std::fs::write(&path, file).unwrap();
    let read = crate::told::load(&path, options).map_err(|error| format!("{error:#}"));
    std::fs::remove_file(&path).unwrap();
    read
}

fn load(file: &str) -> Result<Told, String> {
    load_as(file.as_bytes(), &ImportOptions::new())
}

fn near(a: [f64; 3], b: [f64; 3]) {
    assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-3), "{a:?} is not {b:?}");
}

#[test]
fn a_leg_in_metres_and_z_up_is_turned_to_cm_and_y_up() {
    let leg = load(LEG).unwrap();
    let motion = &leg.motion;
    let names: Vec<String> = (0..motion.rig.joints.len()).map(|joint| motion.rig.joint_name(joint)).collect();
    assert_eq!(names, ["hip", "knee", "foot"]);
    assert_eq!((motion.frames, motion.frame_time, motion.rig.cm_per_unit), (25, 1.0 / 24.0, 1.0));
    assert!(leg.units.contains("as the file says"), "{}", leg.units);
    for frame in 0..25 {
        let angle = (frame as f64 / 24.0) * std::f64::consts::FRAC_PI_2;
        let places = fk::positions(&motion.rig, &motion.values, frame);
        near(places[0], [0.0, 100.0, 0.0]);
        // In the file's axes the knee hangs by (0, 0, -0.5) turned by the pre-rotation and the angle about x.
        let turn = angle + std::f64::consts::FRAC_PI_2;
        let (y, z) = (0.5 * turn.sin(), -0.5 * turn.cos());
        near(places[1], [0.0, 100.0 + 100.0 * z, -100.0 * y]);
    }
    assert_eq!(motion.rig.scalars[0].name, "smile");
    assert!((motion.values.last().unwrap()[24] - 0.5).abs() < 1e-6 && (motion.values.last().unwrap()[12] - 0.25).abs() < 1e-6);
    assert!(leg.warnings.iter().any(|warning| warning.contains("1 cameras")), "{:?}", leg.warnings);
}

/// 24 frames a second are not exact in binary: a frame's time may fall short of its key's.
#[test]
fn a_stepped_curve_has_each_keys_value_at_its_frame() {
    let list = |value: &dyn Fn(i64) -> i64| (0..25).map(|frame| value(frame).to_string()).collect::<Vec<_>>().join(",");
    let keys = "\t\tKeyTime: *2 {\n\t\t\ta: 0,46186158000\n\t\t}\n\t\tKeyValueFloat: *2 {\n\t\t\ta: 0,50\n\t\t}\n\t\tKeyAttrFlags: *1 {\n\t\t\ta: 4\n\t\t}";
    assert_eq!(LEG.matches(keys).count(), 1);
    let stepped = format!(
        "\t\tKeyTime: *25 {{\n\t\t\ta: {}\n\t\t}}\n\t\tKeyValueFloat: *25 {{\n\t\t\ta: {}\n\t\t}}\n\t\tKeyAttrFlags: *1 {{\n\t\t\ta: 2\n\t\t}}",
        list(&|frame| frame * 46_186_158_000 / 24),
        list(&|frame| frame * 37 % 50)
    );
    let (before, after) = LEG.split_once(keys).unwrap();
    let (attributes, rest) = after.split_once("KeyAttrRefCount: *1 {\n\t\t\ta: 2").unwrap();
    let leg = load(&format!("{before}{stepped}{attributes}KeyAttrRefCount: *1 {{\n\t\t\ta: 25{rest}")).unwrap();
    let smile = leg.motion.values.last().unwrap();
    for (frame, value) in smile.iter().enumerate() {
        assert!((value - (frame * 37 % 50) as f64 / 100.0).abs() < 1e-6, "frame {frame}: {value}");
    }
}

#[test]
fn a_unit_that_is_none_is_said() {
    for unit in ["0", "-1"] {
        let leg = load(&LEG.replace(
            "\"UnitScaleFactor\", \"double\", \"Number\", \"\",100",
            &format!("\"UnitScaleFactor\", \"double\", \"Number\", \"\",{unit}"),
        ))
        .unwrap();
        assert!(leg.warnings.iter().any(|warning| warning.contains(&format!("UnitScaleFactor is {unit}"))), "{:?}", leg.warnings);
    }
    assert!(!load(LEG).unwrap().warnings.iter().any(|warning| warning.contains("UnitScaleFactor")));
}

/// [`LEG`] with one more curve of two keys: an axis of a property of a node.
fn with_curve(file: &str, id: u32, node: u32, property: &str, axis: &str, keys: &str) -> String {
    let default = u8::from(property == "Lcl Scaling");
    let defaults: String =
        ["X", "Y", "Z"].map(|axis| format!("\t\t\tP: \"d|{axis}\", \"Number\", \"\", \"A\",{default}\n")).concat();
    let objects = format!(
        "\tAnimationCurveNode: {id}, \"AnimCurveNode::N\", \"\" {{\n\t\tProperties70:  {{\n{defaults}\t\t}}\n\t}}\n\tAnimationCurve: {}, \"AnimCurve::\", \"\" {{\n\t\tDefault: 0\n\t\tKeyVer: 4008\n\
         \t\tKeyTime: *2 {{\n\t\t\ta: 0,46186158000\n\t\t}}\n\t\tKeyValueFloat: *2 {{\n\t\t\ta: {keys}\n\t\t}}\n\t\tKeyAttrFlags: *1 {{\n\t\t\ta: 4\n\t\t}}\n\
         \t\tKeyAttrDataFloat: *4 {{\n\t\t\ta: 0,0,0,0\n\t\t}}\n\t\tKeyAttrRefCount: *1 {{\n\t\t\ta: 2\n\t\t}}\n\t}}\n",
        id + 1
    );
    let connections =
        format!("\tC: \"OO\",{id},21\n\tC: \"OP\",{id},{node}, \"{property}\"\n\tC: \"OP\",{},{id}, \"d|{axis}\"\n", id + 1);
    let file = file.replacen("}\nConnections:  {\n", &format!("{objects}}}\nConnections:  {{\n{connections}"), 1);
    assert!(file.contains(&connections));
    file
}

/// Where the hip, the knee and the foot of a leg whose z scales by `scale` and whose knee is `down` from the hip are, in metres and y up, by the file's own numbers.
fn leg(angle: f64, scale: f64, down: f64) -> [[f64; 3]; 3] {
    let turn = angle + std::f64::consts::FRAC_PI_2;
    let below = |y: f64, z: f64| {
        let (y, z) = (y * turn.cos() - scale * z * turn.sin(), y * turn.sin() + scale * z * turn.cos());
        [0.0, 1.0 + z, -y]
    };
    [[0.0, 1.0, 0.0], below(0.0, -down), below(0.1, -down - 0.5)]
}

#[test]
fn a_scale_that_changes_moves_the_joints_below_and_becomes_scalars() {
    let imported = load(&with_curve(LEG, 60, 1, "Lcl Scaling", "Z", "1,3")).unwrap();
    let motion = &imported.motion;
    for frame in 0..25 {
        let part = frame as f64 / 24.0;
        let expected = leg(part * std::f64::consts::FRAC_PI_2, 1.0 + 2.0 * part, 0.5);
        let places = fk::positions(&motion.rig, &motion.values, frame);
        (0..3).for_each(|joint| near(places[joint], expected[joint].map(|x| 100.0 * x)));
    }
    let scalar = motion.rig.scalars.iter().position(|scalar| scalar.name == "hip.scale.z").unwrap();
    assert!((motion.values[motion.rig.joint_channels() + scalar][12] - 2.0).abs() < 1e-9);
    assert!(imported.warnings.iter().any(|warning| warning.contains("the scale of `hip` changes")), "{:?}", imported.warnings);
}

/// Two hours of a scene with many elements, each of which would be looked at on each frame.
#[test]
fn more_work_than_a_minute_takes_is_refused_at_once() {
    let materials: String = (5000..9000).map(|id| format!("\tMaterial: {id}, \"Material::m\", \"\" {{\n\t}}\n")).collect();
    let file = LEG.replace("\tAnimationLayer: 21,", &format!("{materials}\tAnimationLayer: 21,")).replace(
        "\"LocalStop\", \"KTime\", \"Time\", \"\",46186158000",
        "\"LocalStart\", \"KTime\", \"Time\", \"\",0\n\t\t\tP: \"LocalStop\", \"KTime\", \"Time\", \"\",307907000000000",
    );
    let error = super::processor_time::within(10.0, || load(&file).unwrap_err());
    assert!(error.contains("frames are too many for a scene of 4") && error.contains("--fps takes fewer"), "{error}");
}

/// A second layer scales the hip; ufbx evaluates it whatever its properties say.
#[test]
fn muted_layers_and_those_beside_a_solo_one_are_left_out() {
    let layer = |property: &str| {
        format!(
            "AnimationLayer: 70, \"AnimLayer::grow\", \"\" {{\n\t\tProperties70:  {{\n{property}\t\t}}\n\t}}\n\tAnimationLayer: 21,"
        )
    };
    let with = |property: &str, base: &str| {
        let file = with_curve(LEG, 60, 1, "Lcl Scaling", "Z", "1,3").replace("C: \"OO\",60,21", "C: \"OO\",60,70");
        let file = file
            .replace("C: \"OO\",21,20", "C: \"OO\",21,20\n\tC: \"OO\",70,20")
            .replace("AnimationLayer: 21,", &layer(property));
        load(&file.replace("\"AnimLayer::base\", \"\" {\n", &format!("\"AnimLayer::base\", \"\" {{\n{base}")))
    };
    let base = "\t\tProperties70:  {\n\t\t\tP: \"Solo\", \"bool\", \"\", \"\",1\n\t\t}\n";
    let muted = "\t\t\tP: \"Mute\", \"bool\", \"\", \"\",1\n";
    let plain = load(LEG).unwrap().motion;
    for imported in [with(muted, "").unwrap(), with("", base).unwrap()] {
        assert_eq!(imported.motion.values, plain.values);
        assert!(imported.warnings.iter().any(|warning| warning.ends_with("are left out: `grow`")), "{:?}", imported.warnings);
    }
    let both = with("", "").unwrap();
    assert!(both.motion.values.len() > plain.values.len() && !both.warnings.iter().any(|warning| warning.contains("layers")));
    let error = with("\t\t\tP: \"Solo\", \"bool\", \"\", \"\",1\n", "").unwrap_err();
    assert!(error.contains("layer `grow` adds to a layer below it that does not play"), "{error}");
    // BlendMode 1 overrides.
    let over = "\t\t\tP: \"Solo\", \"bool\", \"\", \"\",1\n\t\t\tP: \"BlendMode\", \"enum\", \"\", \"\",1\n";
    let grow = with(over, "").unwrap();
    assert!(!grow.motion.rig.scalars.iter().any(|scalar| scalar.name == "smile"));
    assert!(grow.warnings.iter().any(|warning| warning.ends_with("are left out: `base`")), "{:?}", grow.warnings);
}

/// The kick turns the hip and moves the knee; the rest moves the hip, which therefore has a moved place too. ufbx gave it the knee's.
#[test]
fn a_place_that_another_stack_moves_is_its_own() {
    let other = "AnimationLayer: 41, \"AnimLayer::base2\", \"\" {\n\t}\n";
    let file = with_curve(LEG, 60, 2, "Lcl Translation", "X", "0,0.3");
    let file = with_curve(&file, 80, 1, "Lcl Translation", "X", "0,0.7")
        .replace("C: \"OO\",80,21", "C: \"OO\",80,41\n\tC: \"OO\",41,40");
    let file = file.replace("\tAnimationLayer: 21,", &format!("\t{other}\tAnimationLayer: 21,"));
    let stack = |name: &str| load_as(file.as_bytes(), &ImportOptions::new().animation(name)).unwrap().motion;
    let kick = stack("kick");
    for frame in 0..25 {
        near(fk::positions(&kick.rig, &kick.values, frame)[0], [0.0, 100.0, 0.0]);
    }
    let rest = stack("rest");
    near(fk::positions(&rest.rig, &rest.values, 24)[0], [70.0, 0.0, 0.0]);
}

/// A second layer holds the knee elsewhere; its weight goes from 0 to 100.
#[test]
fn what_only_the_weight_of_a_layer_moves_moves() {
    let layer = "AnimationLayer: 70, \"AnimLayer::lift\", \"\" {\n\t\tProperties70:  {\n\t\t\tP: \"Weight\", \"Number\", \"\", \"A\",0\n\t\t\tP: \"BlendMode\", \"enum\", \"\", \"\",0\n\t\t}\n\t}\n";
    let file = with_curve(LEG, 60, 2, "Lcl Rotation", "X", "60,60")
        .replace("C: \"OO\",60,21", "C: \"OO\",60,70")
        .replace("C: \"OO\",21,20", "C: \"OO\",21,20\n\tC: \"OO\",70,20");
    let file = with_curve(&file, 80, 70, "Weight", "Weight", "0,100").replace("C: \"OO\",80,21", "C: \"OO\",80,70");
    let (before, weight) = file.split_at(file.find("AnimationCurveNode: 80").unwrap());
    let file = format!("{before}{}", weight.replacen("d|X", "d|Weight", 1));
    let motion = load(&file.replace("\tAnimationLayer: 21,", &format!("\t{layer}\tAnimationLayer: 21,"))).unwrap().motion;
    let knee = motion.rig.joints.iter().position(|joint| joint.name == "knee").unwrap();
    let first = motion.rig.first_channels()[knee];
    let turned = |frame: usize| {
        motion.values[first..first + motion.rig.joints[knee].kinds.len()]
            .iter()
            .map(|values| values[frame].abs())
            .fold(0.0, f64::max)
    };
    assert!(
        turned(0) < 1e-6 && (turned(24) - 60.0).abs() < 1e-6 && (turned(12) - 30.0).abs() < 1.0,
        "{} {}",
        turned(12),
        turned(24)
    );
}

#[test]
fn a_bound_is_kept_against_the_file() {
    // The hip turns by as little, and the knee moves by as little, as would pass for rounding in a large figure, in units of 1 cm to 1 km.
    for unit in ["1", "100", "100000"] {
        let cm: f64 = unit.parse().unwrap();
        let file =
            LEG.replace("\"Number\", \"\",100\n", &format!("\"Number\", \"\",{unit}\n")).replace("a: 0,90", "a: 0,0.00009");
        let file = with_curve(&file, 60, 2, "Lcl Translation", "Z", "-0.5,-0.500006");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("leg.fbx");
        std::fs::write(&path, &file).unwrap();
        let bound = 2e-6 * cm;
        let back = crate::source_places::converted(&path, bound);
        let mut worst = 0f64;
        for frame in 0..25 {
            let part = frame as f64 / 24.0;
            let [f, t] = [0.5f32, 0.500006f32].map(f64::from);
            let expected = leg((part * f64::from(0.00009f32)).to_radians(), 1.0, f + (t - f) * part);
            let places = fk::positions(&back.rig, &back.values, frame);
            worst = (0..3).fold(worst, |worst, joint| worst.max(fk::distance(places[joint], expected[joint].map(|x| cm * x))));
        }
        println!("unit {unit} cm: {worst} of {bound}");
        assert!(worst <= bound, "unit {unit} cm: {worst}, the bound is {bound}");
    }
}

#[test]
fn stacks_are_chosen_by_name_or_number() {
    for choice in ["kick", "0"] {
        let options = ImportOptions::new().animation(choice).fps(60.0);
        assert_eq!(load_as(LEG.as_bytes(), &options).unwrap().motion.frames, 61);
    }
    let rest = load_as(LEG.as_bytes(), &ImportOptions::new().animation("rest")).unwrap();
    assert!(rest.warnings.iter().any(|warning| warning.contains("moves nothing")));
    let wrong = load_as(LEG.as_bytes(), &ImportOptions::new().animation("2"));
    assert!(wrong.unwrap_err().contains("the file has 0 (kick), 1 (rest)"));
}

#[test]
fn damage_gives_an_error_or_a_motion() {
    assert!(load("; FBX 7.4.0 project file\n").is_err());
    assert!(load("Kaydara FBX Binary  \0\u{1a}\0garbage that is no node").unwrap_err().contains("not a readable FBX file"));
    let mut refused = 0;
    for end in (1..LEG.len()).step_by(7) {
        refused += usize::from(load(&LEG[..end]).is_err());
    }
    assert!(refused > 100, "only {refused} beginnings are refused");
    for (from, to) in [
        ("\"LocalStop\", \"KTime\", \"Time\", \"\",46186158000", "\"LocalStop\", \"KTime\", \"Time\", \"\",9000000000000000000"),
        ("*2 {", "*2000000000 {"),
        ("a: 0,90", "a: 0,nan"),
        ("a: 0,90", "a: 0,1e38"),
        ("a: 0,46186158000", "a: 46186158000,0"),
        ("C: \"OO\",1,0", "C: \"OO\",1,3"),
        ("\"UnitScaleFactor\", \"double\", \"Number\", \"\",100", "\"UnitScaleFactor\", \"double\", \"Number\", \"\",-1e300"),
    ] {
        assert!(LEG.contains(from), "{from}");
        if let Ok(read) = load(&LEG.replace(from, to)) {
            assert!(read.motion.values.iter().flatten().all(|value| value.is_finite()), "{to}");
        }
    }
    let nested = format!("; FBX 7.4.0 project file\n{}", "A: {\n".repeat(100_000));
    assert!(load(&nested).is_err());
}
