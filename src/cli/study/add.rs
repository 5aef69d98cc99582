//! `study add`: more seeds and arms for a study.

use std::path::PathBuf;
use std::process::ExitCode;

use super::arms_of;
use crate::cli::output::{self, CommandResult, Failure, counted};
use crate::report::{Arm, Base, Numbers, Study};
use crate::words::{quoted, shell_path};

/// Add seeds and arms to a study.
///
/// The plan of the study, DIR/study.json, gets what it lacks. Runs that exist stay valid and are
/// not done again; 'maxq-lab study DIR' does the new ones. New arms change the numbers of the runs:
/// after that, print the Slurm script or the command lines again.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab study add studies/thesis --seeds 31..60
  maxq-lab study add studies/thesis --arms flat,random_search
  maxq-lab study add studies/thesis --arm slow --set learning.discount=0.99
  maxq-lab study studies/thesis                            do the new runs")]
pub(super) struct AddArgs {
    /// Study folder.
    dir: PathBuf,

    /// More seeds: numbers and inclusive ranges, such as 31..60.
    #[arg(long, value_name = "A..B", required_unless_present_any = ["arms", "arm"])]
    seeds: Option<Numbers>,

    /// More arms, without settings of their own.
    #[arg(long, value_name = "ARM,...", value_delimiter = ',')]
    arms: Vec<String>,

    /// Name of one more arm, which has the settings of --set.
    #[arg(long, value_name = "NAME")]
    arm: Option<String>,

    /// What the arm of --arm does, apart from its settings.
    #[arg(long, value_name = "ARM", requires = "arm", default_value = "evolved")]
    base: String,

    /// Setting of the arm of --arm; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "arm")]
    settings: Vec<String>,
}

impl AddArgs {
    fn arms(&self) -> Result<Vec<Arm>, Failure> {
        let mut arms = arms_of(&self.arms)?;
        if let Some(name) = &self.arm {
            let base = Base::find(&self.base).ok_or_else(|| {
                let found = quoted(&self.base);
                format!("--base: found {found}; allowed: {}", Base::names())
            })?;
            arms.push(Arm {
                name: name.clone(),
                base,
                settings: self.settings.clone(),
            });
        }
        Ok(arms)
    }
}

/// Runs `study add`.
pub(super) fn main(args: &AddArgs) -> CommandResult {
    let mut study = Study::open(&args.dir)?;
    let added = study.add(args.seeds.as_ref(), args.arms()?)?;
    let folder = args.dir.display();
    let said = if added == 0 {
        format!("{folder} has all of these already\n")
    } else {
        format!(
            "added {} to {folder}, which has {} now; next: maxq-lab study {}\n",
            counted(added as u64, "run"),
            study.runs().len(),
            shell_path(&args.dir)
        )
    };
    output::text(&said)?;
    Ok(ExitCode::SUCCESS)
}
