//! The bounds of joints and scalars that a conversion keeps to.

use crate::error::{Error, Setting, require};
use crate::fit::descent::{Level, Plan};
use crate::motion::Motion;
use crate::options::Options;
use anyhow::Result;

/// The errors of joints and scalars that a conversion keeps to.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    /// Of every joint, in cm.
    pub max_cm: f64,
    /// Of all joints in the mean, End Sites left out, in cm.
    pub mean_cm: Option<f64>,
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
            let refusal = || Error::setting(Setting::MeanError, format!("{mean} cm is more than the largest error, {max_cm} cm"));
            require!(mean <= max_cm, refusal());
        }
        let percent = options.max_scalar_error.unwrap_or(Options::MAX_SCALAR_PERCENT);
        Ok(Distance { max_cm, mean_cm, scalar_part: percent / 100.0 })
    }

    /// What is left of the bound for a motion whose joints are `error_cm` from where the file has them: no joint is farther than all of it from the
    /// file.
    pub fn less(self, error_cm: f64) -> Result<Distance> {
        let known = error_cm == 0.0 || error_cm < 0.5 * self.mean_cm.unwrap_or(self.max_cm);
        let refusal = || Error::bound(format!("the file is only known within {error_cm:e} cm, which is too much of the bound"));
        require!(known, refusal());
        Ok(Distance { max_cm: self.max_cm - error_cm, mean_cm: self.mean_cm.map(|mean| mean - error_cm), ..self })
    }

    /// The plan of the fit.
    pub fn plan(&self, effort: Level) -> Plan {
        // A looser bound than by default saves nothing, and leaves first codes too much room.
        let max_cm = self.mean_cm.map_or(self.max_cm, |mean| self.max_cm.min(Options::MAX_OF_MEAN * mean));
        Plan { mean_cm: self.mean_cm, ..effort.plan(max_cm) }
    }
}
