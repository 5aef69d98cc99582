//! The effects of keys, and when a redraw is needed.

use maxq_lab::dashboard::keys::Action;
use maxq_lab::dashboard::{Effect, Input, Mode, ShownGeneration, ViewId};
use maxq_lab::hierarchy::Glyphs::Unicode;
use maxq_lab::lab::{Event, Keep};

use super::common;
use super::recorded::{Recorded, Screen, foraging};

fn screen() -> Screen {
    foraging().screen("dark", Unicode, (120, 40))
}

fn live() -> Screen {
    let mut screen = foraging().blank(Mode::Live, "dark", Unicode);
    for event in &foraging().events[..4] {
        screen.send(event.clone());
    }
    screen.wait(0.1);
    screen
}

fn generation(screen: &Screen) -> u64 {
    screen.0.app().context().shown().unwrap().generation
}

#[test]
fn every_view_draws_at_every_size() {
    let mut screen = screen();
    let tiny = (0..5).flat_map(|width| (0..5).map(move |height| (width, height)));
    let others = [
        (3, 200),
        (200, 2),
        (39, 12),
        (40, 12),
        (41, 13),
        (80, 24),
        (300, 100),
    ];
    for (width, height) in tiny.chain(others) {
        screen.0.update(Input::Resize(width, height));
        for view in ViewId::all() {
            screen.0.open(view);
            let text = screen.text();
            if width >= 40 && height >= 12 {
                assert!(text.contains(view.title()), "{width}x{height}: {text}");
            } else if width >= 9 && height >= 1 {
                assert!(text.contains("too small"), "{width}x{height}: {text}");
            }
        }
    }
}

/// Time travel to a generation whose individuals were not kept.
#[test]
fn the_nearest_kept_generation_stands_in_and_says_so() {
    let run = Recorded::keeping(&common::short(&[]), Keep::Every(3));
    let mut screen = run.screen("dark", Unicode, (120, 40));
    let subject = |screen: &Screen| screen.0.app().context().player.subject().unwrap();
    for (wanted, stands_in) in [(2, 3), (4, 3), (5, 6), (3, 3)] {
        screen.0.travel_to(wanted);
        assert_eq!(generation(&screen), wanted);
        assert_eq!(subject(&screen).generation, stands_in);
        let context = screen.0.app().context();
        assert!(context.player.individual().is_some() && context.player.load_error().is_none());
        let text =
            format!("generation {wanted} were not kept; shown: the nearest kept, of generation");
        let said = context.log().iter().any(|(said, _)| said.contains(&text));
        assert_eq!(said, wanted != stands_in);
    }
    // Keys go through all generations, not only through the kept ones.
    screen.press("[ [");
    assert_eq!(generation(&screen), 1);
}

/// The size of the run folder is part of the status.
#[test]
fn the_size_of_the_folder_is_shown() {
    let mut screen = screen();
    screen.press("7");
    assert!(!screen.text().contains("folder size"));
    screen.0.update(Input::FolderBytes(39_400_000));
    assert!(
        screen.text().contains("folder size 39 MB"),
        "{}",
        screen.text()
    );
}

#[test]
fn a_halted_rollout_in_a_finished_run_draws_nothing() {
    let mut screen = screen();
    screen.0.take_dirty();
    screen.wait(0.2);
    assert!(screen.0.take_dirty(), "the rollout moves");
    screen.press("space");
    screen.wait(0.1);
    assert!(screen.0.take_dirty(), "it was halted");
    for _ in 0..100 {
        screen.wait(0.1);
        assert!(!screen.0.take_dirty());
    }
}

#[test]
fn a_rollout_halted_before_its_first_step_names_the_key_to_resume() {
    let mut screen = screen();
    screen.press("0");
    for key in ["space", ".", ".", ",", "r"] {
        screen.press(key);
    }
    let text = screen.text();
    assert!(
        text.contains("this rollout has no time step yet: . takes one"),
        "{text}"
    );
    screen.press(".");
    assert!(screen.text().contains("step 1 "), "{}", screen.text());
}

#[test]
fn an_invisible_rollout_does_not_advance() {
    let mut screen = screen();
    screen.press("4");
    screen.0.take_dirty();
    screen.wait(1.0);
    assert!(!screen.0.take_dirty());
}

#[test]
fn keys_reach_all_generations() {
    let mut screen = screen();
    assert_eq!(generation(&screen), 6);
    screen.press("[ [");
    assert_eq!(generation(&screen), 4);
    let subject = screen.0.app().context().player.subject().unwrap();
    assert_eq!(subject.generation, 4, "the rollout is of that time");
    assert!(screen.text().contains("PAST of 6"));
    screen.press("{");
    assert_eq!(generation(&screen), 1);
    screen.press("P");
    screen.wait(0.3);
    assert_eq!(generation(&screen), 2);
    screen.wait(2.0);
    assert_eq!(
        (generation(&screen), screen.0.app().context().time()),
        (6, ShownGeneration::Latest)
    );
}

#[test]
fn a_frozen_display_stays_while_evolution_continues() {
    let mut screen = live();
    assert_eq!(generation(&screen), 3);
    screen.press("f");
    screen.send(foraging().events[4].clone());
    assert_eq!(generation(&screen), 3);
    assert_eq!(
        screen.0.app().context().live_history().generations().len(),
        4
    );
    screen.press("f");
    assert_eq!(generation(&screen), 4);
}

/// The hierarchy beside a halted rollout is the one of the rollout, however far evolution has
/// advanced.
#[test]
fn arena_and_hierarchy_show_the_same_individual() {
    let mut screen = live();
    screen.0.update(Input::Resize(120, 40));
    screen.press("space");
    let subject = screen.0.app().context().player.subject().unwrap();
    for event in &foraging().events[4..] {
        screen.send(event.clone());
        screen.wait(1.0);
    }
    let context = screen.0.app().context();
    assert_eq!(context.player.subject(), Some(subject));
    let (generation, inspected) = context.inspected().unwrap();
    assert_eq!((generation, inspected.id), (subject.generation, subject.id));
    let caption = format!("id {}, gen {}", subject.id, subject.generation);
    assert_eq!(
        screen.text().matches(&caption).count(),
        2,
        "{}",
        screen.text()
    );
}

/// Both individuals of a comparison are of the inspected generation.
#[test]
fn compared_individuals_are_of_one_generation() {
    let mut screen = live();
    screen.0.update(Input::Resize(120, 40));
    screen.press("space");
    let generation = screen
        .0
        .app()
        .context()
        .player
        .subject()
        .unwrap()
        .generation;
    for event in &foraging().events[4..] {
        screen.send(event.clone());
        screen.wait(1.0);
    }
    screen.press("c");
    let text = screen.text();
    assert_eq!(
        text.matches(&format!(", generation {generation}")).count(),
        2,
        "{text}"
    );
    assert_eq!(text.matches("selects").count(), 2, "{text}");
}

#[test]
fn keys_steer_evolution() {
    let mut screen = live();
    assert_eq!(screen.press("p"), [Effect::Pause]);
    screen.send(Event::Paused);
    assert!(screen.text().contains("PAUSED"));
    assert_eq!(screen.press("n"), [Effect::Step]);
    screen.send(Event::Resumed);
    assert!(screen.text().contains("STEPPING"));
    screen.send(Event::Paused);
    assert_eq!(screen.press("p"), [Effect::Resume]);
    assert_eq!(screen.press("w"), [Effect::Checkpoint]);
    assert_eq!(screen.press("X n"), [], "no was the answer");
    assert_eq!(screen.press("X y"), [Effect::Stop]);
}

#[test]
fn quitting_a_live_run_asks_a_question() {
    let mut screen = live();
    assert_eq!(screen.press("q"), []);
    assert_eq!(screen.press("n"), []);
    assert_eq!(screen.press("q d"), [Effect::Detach]);
    assert_eq!(screen.press("q y"), [Effect::Quit]);
    screen.0.update(Input::Closed);
    assert_eq!(
        screen.press("q"),
        [Effect::Quit],
        "there is nothing to lose"
    );
}

#[test]
fn a_replay_cannot_be_steered_and_says_so() {
    let mut screen = screen();
    for key in ["p", "n", "w", "X"] {
        assert_eq!(screen.press(key), []);
        assert!(screen.text().contains("no evolution to steer"), "{key}");
    }
    assert_eq!(screen.press("q"), [Effect::Quit]);
}

#[test]
fn every_view_can_be_exported() {
    let mut screen = screen();
    for (keys, name, begin) in [
        ("e t", "overview-generation6.txt", " ✓ FINISHED"),
        ("e a", "overview-generation6.ansi", "\u{1b}[0"),
        ("e s", "overview-generation6.svg", "<svg"),
        ("3 e d", "hierarchy-generation6.dot", "digraph"),
        ("4 e c", "fitness-generation6.csv", "generation,best_steps"),
        ("5 e c", "policy-generation6.csv", "generation,state_type"),
        ("6 e c", "population-generation6.csv", "rank,id"),
    ] {
        let effects = screen.press(keys);
        let [Effect::Export(export)] = &effects[..] else {
            panic!("{keys}: {effects:?}");
        };
        assert_eq!(export.name, name);
        assert!(export.contents.starts_with(begin), "{}", export.contents);
    }
}

#[test]
fn help_names_every_key_of_a_view() {
    let mut screen = foraging().screen("dark", Unicode, (150, 120));
    screen.press("6 ?");
    let text = screen.text();
    for action in [Action::Sort, Action::Help, Action::Pause, Action::Earlier] {
        let description = action.description().trim_end_matches('.');
        assert!(text.contains(description), "{description}: {text}");
    }
    assert!(!text.contains("The panel before"), "{text}");
}

/// A column of a chart keeps its meaning while generations are added: the picture is steady,
/// and fewer bytes are sent.
#[test]
fn the_axis_of_generations_is_steady() {
    let mut screen = live();
    screen.0.update(Input::Resize(120, 40));
    screen.press("4");
    // The line below a chart: the ends of the axis, and the shown generation.
    let axis = |screen: &Screen| {
        let text = screen.text();
        let lines = text.lines().map(|line| line.trim_matches('│'));
        let is_axis = |line: &&str| {
            let mut words = line.split_whitespace();
            line.contains(" 1 ") && words.all(|word| word.parse::<u32>().is_ok())
        };
        let axes: Vec<_> = lines.filter(is_axis).map(str::to_owned).collect();
        let [fitness, difference] = &axes[..] else {
            panic!("{text}")
        };
        assert_eq!(fitness, difference, "one axis for both charts");
        let ends: Vec<_> = fitness.match_indices(['1', '6']).collect();
        let ends = ends.into_iter().map(|(at, end)| (at, end.to_owned()));
        ends.collect::<Vec<_>>()
    };
    let before = axis(&screen);
    assert_eq!(before.len(), 2, "{before:?}");
    screen.send(foraging().events[4].clone());
    assert_eq!(generation(&screen), 4);
    assert_eq!(axis(&screen), before);
}

/// Keys select a subtask, which is explained below the tree and shown by the inspector.
#[test]
fn a_subtask_is_selected_in_the_hierarchy() {
    let mut screen = screen();
    let tree = screen.0.app().context().inspected_tree().unwrap();
    screen.press("3 j");
    let subtask = foraging().experiment.catalogue().subtask(tree.subtask(1));
    let about = format!("{}: {}", subtask.name, subtask.purpose);
    assert!(
        screen.text().contains(&about),
        "{about} in\n{}",
        screen.text()
    );
    screen.press("G");
    assert_eq!(
        screen.0.app().context().node_in(&tree),
        tree.nodes().len() - 1
    );
    screen.press("k k enter");
    assert_eq!(screen.0.app().view(), ViewId::Inspector);
    assert_eq!(
        screen.0.app().context().node_in(&tree),
        tree.nodes().len() - 3
    );
}

#[test]
fn selecting_an_individual_switches_the_rollout() {
    let mut screen = screen();
    let best = screen.0.app().context().player.subject().unwrap();
    screen.press("6 j 2");
    let second = screen.0.app().context().player.subject().unwrap();
    assert_ne!(best.id, second.id);
    let context = screen.0.app().context();
    assert_eq!(context.shown().unwrap().individuals[1].id, second.id);
    screen.press("b");
    assert_eq!(screen.0.app().context().player.subject(), Some(best));
}

/// A run that was opened from a table of runs names the back key.
#[test]
fn the_way_back_is_named() {
    let mut screen = screen();
    assert!(screen.text().contains("q quit"));
    screen.press("6");
    assert!(screen.text().contains("↑↓ select"), "{}", screen.text());
    let opened = foraging().blank_with_back();
    assert!(opened.text().contains("esc back"), "{}", opened.text());
    assert!(!opened.text().contains("q quit"));
}

#[test]
fn control_characters_of_a_run_are_escaped() {
    let mut screen = screen();
    let Event::Generation(mut record) = foraging().events[1].clone() else {
        panic!("no generation");
    };
    record.generation = 7;
    record.individuals[0].tree = String::from("(Root \u{1b}[31mX\u{9b}2J)");
    let probabilities = record.selection_probabilities[0].get_or_insert_default();
    probabilities.insert(String::from("\u{1b}]0;x\u{7}"), 0.7);
    screen.send(Event::Generation(record));
    screen.0.update(Input::Message(String::from("a\nb\u{1b}c")));
    for view in ViewId::all() {
        screen.0.open(view);
        let frame = screen.0.app().frame();
        let mut symbols = frame.content.iter().flat_map(|cell| cell.symbol().chars());
        assert!(!symbols.any(char::is_control), "{view:?}");
    }
}

/// The output of the program, or its error message.
fn frame(arguments: &[&str]) -> Result<String, String> {
    let mut command = common::program();
    command.arg("frame").arg(&foraging().folder).args(arguments);
    let output = common::output(command.env("LC_ALL", "C.UTF-8").env_remove("NO_COLOR"));
    if output.status.success() {
        Ok(common::stdout(&output))
    } else {
        Err(common::stderr(&output))
    }
}

#[test]
fn a_frame_is_printed_without_a_terminal_and_the_same_each_time() {
    let arguments = ["--size", "80x24", "--play", "2", "--generation", "3"];
    let text = frame(&arguments).unwrap();
    assert_eq!(text.lines().count(), 24);
    assert!(
        text.contains("generation 3") && text.contains("PAST of 6"),
        "{text}"
    );
    assert_eq!(frame(&arguments).unwrap(), text);
    let keyed = ["--size", "80x24", "--keys", "4", "--format", "svg"];
    let svg = frame(&keyed).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("Fitness"), "{svg}");
    let ascii = frame(&["--ascii", "--theme", "mono"]).unwrap();
    assert!(ascii.is_ascii(), "{ascii}");
}

/// The keys of an export write its file, as in the dashboard.
#[test]
fn a_frame_writes_what_its_keys_export() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = common::program();
    command
        .current_dir(&folder)
        .arg("frame")
        .arg(&foraging().folder);
    let output = common::output(command.args(["--view", "fitness", "--keys", "e t e u e c"]));
    let said = common::stderr(&output);
    assert!(output.status.success(), "{said}");
    let name = "fitness-generation6.csv";
    let csv = std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(csv.lines().count(), 7, "{csv}");
    assert!(
        said.contains("removed: ./fitness-generation6.txt"),
        "{said}"
    );
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    assert!(
        said.contains(&format!("written: {name} (e u removes it) in ")),
        "{said}"
    );
}

#[test]
fn an_impossible_frame_is_an_error_that_names_what_is_allowed() {
    for (arguments, allowed) in [
        (["--size", "80"], "COLUMNSxROWS"),
        (["--view", "arenas"], "population"),
        (["--theme", "dusk"], "high-contrast"),
        (["--keys", "pagedown"], "page-down"),
        (["--play", "-1"], "0 to 3600"),
        (["--generation", "7"], "1 to 6"),
        (["--format", "png"], "svg"),
    ] {
        let [option, value] = arguments;
        let error = frame(&[&format!("{option}={value}")]).unwrap_err();
        assert!(error.contains(value) && error.contains(allowed), "{error}");
    }
    let help = frame(&["--help"]).unwrap();
    for view in ViewId::all() {
        assert!(help.contains(view.name()), "{} is in no help", view.name());
    }
}
