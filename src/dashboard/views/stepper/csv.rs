//! A time step as a table.

use std::fmt::Write;

use super::Shown;

/// One number a line: what it is of, and its value.
pub(super) fn csv(shown: &Shown<'_>) -> String {
    let trace = shown.trace;
    let mut csv = String::from("trial,step,node,subtask,item,quantity,value\n");
    let mut add = |node: usize, item: &str, quantity: &str, value: String| {
        let subtask = shown.name(node);
        // Writing to a string cannot fail.
        let _ = writeln!(
            csv,
            "{},{},{node},{subtask},{},{quantity},{value}",
            trace.trial,
            trace.step,
            quoted(item)
        );
    };
    for level in &trace.explanation.levels {
        add(level.node, "", "temperature", level.temperature.to_string());
        for choice in &level.choices {
            let name = shown.name(choice.node);
            for (quantity, value) in [
                ("v", choice.value),
                ("c_tilde", choice.c_tilde),
                ("c", choice.c),
                ("probability", choice.probability),
            ] {
                add(level.node, name, quantity, value.to_string());
            }
        }
        let active = shown.name(level.active);
        add(
            level.node,
            active,
            "chosen",
            u8::from(level.chose).to_string(),
        );
    }
    let action = &trace.explanation.action;
    let values = action.values.iter().zip(&action.probabilities);
    for (label, (value, probability)) in shown.actions(action.node).iter().zip(values) {
        add(action.node, label, "q", value.to_string());
        add(action.node, label, "probability", probability.to_string());
    }
    if let Some(label) = shown.actions(action.node).get(action.chosen) {
        add(action.node, label, "chosen", String::from("1"));
    }
    add(
        action.node,
        "",
        "reward",
        trace.explanation.reward.to_string(),
    );
    for update_trace in &trace.explanation.update_traces {
        let child = shown.name(update_trace.child);
        add(
            update_trace.node,
            child,
            "pseudo_reward",
            update_trace.pseudo_reward.to_string(),
        );
        for (quantity, value) in [
            ("c_tilde_before", update_trace.c_tilde.before),
            ("c_tilde_after", update_trace.c_tilde.after),
            ("c_before", update_trace.c.before),
            ("c_after", update_trace.c.after),
        ] {
            add(update_trace.node, child, quantity, value.to_string());
        }
        for update in &update_trace.updates {
            let n = update.steps;
            let (inside, outside) = (update.error_inside, update.error_outside);
            add(
                update_trace.node,
                child,
                &format!("error_c_tilde_n{n}"),
                inside.to_string(),
            );
            add(
                update_trace.node,
                child,
                &format!("error_c_n{n}"),
                outside.to_string(),
            );
        }
        if let Some(end) = update_trace.termination {
            add(
                update_trace.node,
                "",
                "at_goal",
                u8::from(end.at_goal).to_string(),
            );
        }
    }
    csv
}

/// A label as a field: those of actions hold commas.
fn quoted(text: &str) -> String {
    match text.contains(',') {
        true => format!("\"{text}\""),
        false => text.to_owned(),
    }
}
