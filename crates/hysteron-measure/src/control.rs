//! Makes docs/measured/control.md: controllers compared on the built-in scenarios, medians over
//! their seeds.
//!
//! ```text
//! cargo run --release -p hysteron-measure -- control > docs/measured/control.md
//! ```

mod bound;
mod scene;

use crate::result::Result;
use hysteron_sim::track::Scenario;
use scene::Scene;

/// Runs of each scenario.
const SEEDS: u32 = 10;
/// An error that is larger by no more than this share is as good.
const AS_GOOD: f64 = 0.05;

/// All built-in scenarios, or those named.
pub(crate) fn run(names: &[String]) -> Result<()> {
    let mut scenes = Vec::new();
    for name in Scenario::names() {
        if names.is_empty() || names.iter().any(|asked| asked == name) {
            eprintln!("{name} …");
            scenes.push(Scene::run(name, SEEDS)?);
        }
    }
    print!("{}", include_str!("text/control.md"));
    println!("\n## Where learning loses\n");
    println!("Errors over those of the fixed inverse, where they are larger by more than 5 %:\n");
    list(&scenes, |scene| scene.lost_to_fixed(1.0 + AS_GOOD));
    println!("\nErrors of adaptive inverse and PID over those of the better PID alone:\n");
    list(&scenes, |scene| scene.lost_to_pid(1.0 + AS_GOOD));
    println!(
        "\nErrors of the better PI/RLS over those of the best inverse with PID, where it wins:\n"
    );
    list(&scenes, |scene| scene.won_by_pi_rls(1.0 + AS_GOOD));
    print!("{}", include_str!("text/control-why.md"));
    for scene in &scenes {
        scene.print();
    }
    Ok(())
}

fn list(scenes: &[Scene], of: impl Fn(&Scene) -> Vec<String>) {
    for scene in scenes {
        let lost = of(scene);
        if !lost.is_empty() {
            println!("- `{}`: {}.", scene.name, lost.join(";\n  "));
        }
    }
}
