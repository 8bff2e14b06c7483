//! What is said of a fit: its errors, its verdict, and what there is to know.

use super::fault::{Fault, spelt};
use hysteron::{
    Advice, Doubt, Errors, HeldOut, HoldOut, Model, Recording, Verdict, advice, doubts,
};

/// What is said of a fit.
#[derive(Debug, Clone)]
pub(super) struct Judged {
    pub(super) held_out: Option<HeldOut>,
    /// The errors of the inverse on what was fitted, while the output moves.
    pub(super) inverse: Option<Errors>,
    pub(super) advice: Vec<String>,
    /// Whether it is good enough: headings and sentences.
    pub(super) verdict: Vec<(String, String)>,
}

impl Judged {
    /// What is said of a model that was fitted to `recordings` while `what` was held out, which
    /// gave `held_out`. Its record has that, too.
    pub(super) fn of(
        model: &Model,
        recordings: &[Recording],
        what: Option<&HoldOut>,
        held_out: Option<HeldOut>,
    ) -> Result<Self, Fault> {
        let doubts = doubts_in(recordings)?;
        let verdict = Verdict::of_fit_holding_out(model, recordings, what)?;
        let verdict = verdict.doubting(doubts.len());
        let lines = verdict.lines(spelt).into_iter();
        let mut all: Vec<Advice> = advice(model, recordings)?;
        all.extend(held_out.iter().flat_map(HeldOut::advice));
        let doubts = doubts.iter();
        let doubts = doubts.map(|doubt| format!("{doubt}: {}", doubt.remedy().spelt(spelt)));
        let advice = all.iter();
        let advice = advice.map(|advice| format!("{advice}: {}", advice.remedy().spelt(spelt)));
        Ok(Self {
            inverse: verdict.inverse,
            verdict: lines
                .map(|(heading, text)| (heading.to_owned(), text))
                .collect(),
            advice: doubts.chain(advice).collect(),
            held_out,
        })
    }
}

/// The rows in doubt of all recordings.
pub(super) fn doubts_in(recordings: &[Recording]) -> Result<Vec<Doubt>, Fault> {
    let each = recordings.iter().map(doubts);
    Ok(each.collect::<Result<Vec<_>, _>>()?.concat())
}
