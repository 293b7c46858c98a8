//! The bounds of joints and scalars that a conversion keeps to.

use crate::error::{Error, Setting, require};
use crate::fit::{descent::Plan, level::Level};
use crate::motion::Motion;
use crate::options::Options;
use crate::pose_bound::{PoseBound, Shell};
use crate::verify::shell_radius_cm;
use anyhow::Result;

/// The errors of joints and scalars that a conversion keeps to.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    /// Of joints.
    pub pose: PoseBound,
    /// Of scalars, as a part of full scale.
    pub scalar_part: f64,
}

impl Distance {
    /// What `options` ask for.
    pub fn of(options: &Options, motion: &Motion) -> Result<Distance> {
        let mean_cm = options.mean_error.map(|mean| mean.of(motion)).transpose()?;
        let max_cm = match (options.max_error, mean_cm) {
            (Some(max), _) => max.of(motion)?,
            (None, Some(mean)) => Options::MAX_OF_MEAN * mean,
            (None, None) => Options::MAX_ERROR.of(motion)?,
        };
        if let Some(mean) = mean_cm {
            let refusal = || {
                Error::value(Setting::MeanError, format!("{mean} cm"), format!("it is more than the largest error, {max_cm} cm"))
            };
            require!(mean <= max_cm, refusal());
        }
        let shell = match options.shell {
            _ if options.places_only => Shell::Places,
            Some(shell) => Shell::Cm(shell.of(motion)?),
            None => Shell::Cm(shell_radius_cm(motion)),
        };
        let (max_rotation_deg, max_joint_deg) = (options.max_rotation_error, options.max_joint_error);
        let percent = options.max_scalar_error.unwrap_or(Options::MAX_SCALAR_PERCENT);
        let pose = PoseBound { max_cm, shell, max_rotation_deg, max_joint_deg, mean_cm };
        Ok(Distance { pose, scalar_part: percent / 100.0 })
    }

    /// What is left of the bound for a motion whose joints are `error_cm` from where the file has them: no joint is farther than all of it from the
    /// file.
    pub fn less(self, error_cm: f64) -> Result<Distance> {
        let PoseBound { max_cm, mean_cm, .. } = self.pose;
        let known = error_cm == 0.0 || error_cm < 0.5 * mean_cm.unwrap_or(max_cm);
        let refusal = || Error::bound(format!("the file is only known within {error_cm:e} cm, which is too much of the bound"));
        require!(known, refusal());
        let pose = PoseBound { max_cm: max_cm - error_cm, mean_cm: mean_cm.map(|mean| mean - error_cm), ..self.pose };
        Ok(Distance { pose, ..self })
    }

    /// The plan of the fit.
    pub fn plan(&self, effort: Level) -> Plan {
        let PoseBound { max_cm, mean_cm, .. } = self.pose;
        // A looser bound than by default saves nothing, and leaves first codes too much room.
        let max_cm = mean_cm.map_or(max_cm, |mean| max_cm.min(Options::MAX_OF_MEAN * mean));
        effort.plan(PoseBound { max_cm, ..self.pose })
    }
}
