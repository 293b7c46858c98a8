//! Names and units of the facial animation parameters (ISO/IEC 14496-2, Annex C).

/// Low-level parameters and the two of a higher level.
pub const PARAMETERS: usize = 68;

/// What a value of 1 is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Iris diameter / 1024.
    Irisd,
    /// Eye separation / 1024.
    Es,
    /// Eye-nose separation / 1024.
    Ens,
    /// Mouth-nose separation / 1024.
    Mns,
    /// Mouth width / 1024.
    Mw,
    /// Angle unit: 10^-5 radians.
    Au,
    /// A choice among N values, or a fraction of N.
    Of(u8),
}

use Unit::{Au, Ens, Es, Irisd, Mns, Mw, Of};

/// Names and units of parameters 3 to 68, in order.
const LOW: [(&str, Unit); PARAMETERS - 2] = [
    ("open_jaw", Mns),
    ("lower_t_midlip", Mns),
    ("raise_b_midlip", Mns),
    ("stretch_l_cornerlip", Mw),
    ("stretch_r_cornerlip", Mw),
    ("lower_t_lip_lm", Mns),
    ("lower_t_lip_rm", Mns),
    ("raise_b_lip_lm", Mns),
    ("raise_b_lip_rm", Mns),
    ("raise_l_cornerlip", Mns),
    ("raise_r_cornerlip", Mns),
    ("thrust_jaw", Mns),
    ("shift_jaw", Mw),
    ("push_b_lip", Mns),
    ("push_t_lip", Mns),
    ("depress_chin", Mns),
    ("close_t_l_eyelid", Irisd),
    ("close_t_r_eyelid", Irisd),
    ("close_b_l_eyelid", Irisd),
    ("close_b_r_eyelid", Irisd),
    ("yaw_l_eyeball", Au),
    ("yaw_r_eyeball", Au),
    ("pitch_l_eyeball", Au),
    ("pitch_r_eyeball", Au),
    ("thrust_l_eyeball", Es),
    ("thrust_r_eyeball", Es),
    ("dilate_l_pupil", Irisd),
    ("dilate_r_pupil", Irisd),
    ("raise_l_i_eyebrow", Ens),
    ("raise_r_i_eyebrow", Ens),
    ("raise_l_m_eyebrow", Ens),
    ("raise_r_m_eyebrow", Ens),
    ("raise_l_o_eyebrow", Ens),
    ("raise_r_o_eyebrow", Ens),
    ("squeeze_l_eyebrow", Es),
    ("squeeze_r_eyebrow", Es),
    ("puff_l_cheek", Es),
    ("puff_r_cheek", Es),
    ("lift_l_cheek", Ens),
    ("lift_r_cheek", Ens),
    ("shift_tongue_tip", Mw),
    ("raise_tongue_tip", Mns),
    ("thrust_tongue_tip", Mw),
    ("raise_tongue", Mns),
    ("tongue_roll", Au),
    ("head_pitch", Au),
    ("head_yaw", Au),
    ("head_roll", Au),
    ("lower_t_midlip_o", Mns),
    ("raise_b_midlip_o", Mns),
    ("stretch_l_cornerlip_o", Mw),
    ("stretch_r_cornerlip_o", Mw),
    ("lower_t_lip_lm_o", Mns),
    ("lower_t_lip_rm_o", Mns),
    ("raise_b_lip_lm_o", Mns),
    ("raise_b_lip_rm_o", Mns),
    ("raise_l_cornerlip_o", Mns),
    ("raise_r_cornerlip_o", Mns),
    ("stretch_l_nose", Ens),
    ("stretch_r_nose", Ens),
    ("raise_nose", Ens),
    ("bend_nose", Ens),
    ("raise_l_ear", Ens),
    ("raise_r_ear", Ens),
    ("pull_l_ear", Ens),
    ("pull_r_ear", Ens),
];

/// What parameter 1 holds: files leave out the last one or do not.
pub const VISEME: [(&str, Unit); 4] =
    [("viseme_select1", Of(14)), ("viseme_select2", Of(14)), ("viseme_blend", Of(63)), ("viseme_def", Of(1))];

/// What parameter 2 holds: files leave out the last two or do not.
pub const EXPRESSION: [(&str, Unit); 6] = [
    ("expression_select1", Of(6)),
    ("expression_intensity1", Of(63)),
    ("expression_select2", Of(6)),
    ("expression_intensity2", Of(63)),
    ("init_face", Of(1)),
    ("expression_def", Of(1)),
];

/// Values of parameters 1 and 2 without those that files leave out.
pub const SHORT: [usize; 2] = [3, 4];

/// Name and unit of each value, in the order of a row that gives all.
pub fn values() -> impl Iterator<Item = (&'static str, Unit)> {
    VISEME.into_iter().chain(EXPRESSION).chain(LOW)
}
