//! A time step as CSV.

use std::fmt::Display;

use super::ShownStep;
use crate::dashboard::views::shared::csv_line;
use crate::learning::Exit;

/// Writes a time step as a table with one number per line.
pub(super) fn csv(shown: &ShownStep<'_>) -> String {
    let trace = shown.trace;
    let mut csv = String::from("trial,step,node,subtask,item,quantity,value\n");
    let mut add = |node: usize, item: &str, quantity: &str, value: &dyn Display| {
        let (trial, step, subtask) = (&trace.trial, &trace.step, shown.name(node));
        csv_line(
            &mut csv,
            &[trial, step, &node, &subtask, &item, &quantity, value],
        );
    };
    for level in &trace.explanation.levels {
        add(level.node, "", "temperature", &level.temperature);
        for choice in &level.choices {
            let name = shown.name(choice.node);
            add(level.node, name, "v", &choice.value);
            add(level.node, name, "c_tilde", &choice.c_tilde);
            add(level.node, name, "c", &choice.c);
            add(level.node, name, "probability", &choice.probability);
        }
        let active = shown.name(level.active);
        add(level.node, active, "chosen", &u8::from(level.chose));
    }
    let action = &trace.explanation.action;
    let values = action.values.iter().zip(&action.probabilities);
    for (label, (value, probability)) in shown.actions(action).iter().zip(values) {
        add(action.node, label, "q", value);
        add(action.node, label, "probability", probability);
    }
    if let Some(label) = shown.actions(action).get(action.chosen) {
        add(action.node, label, "chosen", &1);
    }
    add(action.node, "", "reward", &trace.explanation.reward);
    for update_trace in &trace.explanation.update_traces {
        let (node, child) = (update_trace.node, shown.name(update_trace.child));
        match update_trace.exit {
            Exit::PseudoReward(reward) => add(node, child, "pseudo_reward", &reward),
            Exit::Continuation { value, .. } => add(node, child, "exit_value", &value),
            Exit::None => {}
        }
        add(node, child, "c_tilde_before", &update_trace.c_tilde.before);
        add(node, child, "c_tilde_after", &update_trace.c_tilde.after);
        add(node, child, "c_before", &update_trace.c.before);
        add(node, child, "c_after", &update_trace.c.after);
        for update in &update_trace.updates {
            let n = update.steps;
            add(
                node,
                child,
                &format!("error_c_tilde_n{n}"),
                &update.error_inside,
            );
            add(node, child, &format!("error_c_n{n}"), &update.error_outside);
        }
        if let Some(end) = update_trace.termination {
            add(node, "", "at_goal", &u8::from(end.at_goal));
        }
    }
    for replayed in &trace.explanation.replayed {
        let (node, child) = (replayed.node, shown.name(replayed.child));
        add(node, child, "replayed_updates", &replayed.updates);
        add(node, child, "replayed_mean_error", &replayed.mean_error);
    }
    csv
}
