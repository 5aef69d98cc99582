//! The dashboard: whatever it is told and however large the screen, it draws.
//!
//! Why it matters: it is the program's face, over lines and terminals that nobody chose,
//! and one panic would take a run of hours with it.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use maxq_lab::dashboard::keys::KeyMap;
use maxq_lab::dashboard::look::{Look, Signs, Theme};
use maxq_lab::dashboard::{App, FrameFormat, Input, Mode, ViewId, render};
use maxq_lab::hierarchy::Glyphs;
use maxq_lab::lab::specimen::{Bench, bench};
use maxq_lab::lab::{Event, read_events};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// The events of a small run.
fn events() -> Vec<Event> {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("run");
    common::run_in(&folder, &common::short(&[]), 1, &common::threads(1));
    read_events(&folder.join("events.jsonl")).unwrap()
}

fn app(bench: &'static dyn Bench) -> App {
    let folder = String::from("runs/smoke-seed1");
    let look = Look::new(Theme::all(), "dark", Signs::of(Glyphs::Unicode));
    let mut app = App::new(bench, folder, Mode::Replay, look, KeyMap::default());
    for event in events() {
        app.update(Input::Event(Box::new(event)));
    }
    app
}

fn frame(app: &App, (width, height): (u16, u16)) -> Buffer {
    let mut buffer = Buffer::empty(Rect::new(0, 0, width, height));
    app.draw_on(&mut buffer);
    buffer
}

#[test]
fn every_view_draws_at_every_size() {
    let bench = bench(common::short(&[]), 1).unwrap();
    let mut app = app(bench);
    for view in ViewId::all() {
        app.open(view);
        for size in [
            (0, 0),
            (1, 1),
            (3, 200),
            (200, 2),
            (39, 12),
            (40, 12),
            (80, 24),
            (120, 40),
            (200, 60),
        ] {
            app.update(Input::Resize(size.0, size.1));
            let text = render(&frame(&app, size), FrameFormat::Text);
            if size.0 >= 40 && size.1 >= 12 {
                assert!(text.contains(view.title()), "{size:?}: {text}");
            } else if size.0 >= 9 {
                assert!(text.contains("too small"), "{size:?}: {text}");
            }
        }
    }
}
