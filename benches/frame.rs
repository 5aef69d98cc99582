//! The time to draw a frame of the dashboard: the goal at 200x60 is below 2 ms.

#![allow(missing_docs, clippy::unwrap_used)]

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use maxq_lab::dashboard::keys::KeyMap;
use maxq_lab::dashboard::look::{Look, Signs, Theme};
use maxq_lab::dashboard::{App, Input, Mode, OffscreenDashboard, ViewContext, ViewId};
use maxq_lab::hierarchy::Glyphs;
use maxq_lab::lab::inspection::Archive;
use maxq_lab::lab::{Recording, RunOptions, lasting_experiment, start};
use maxq_lab::scenario::Scenario;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

fn frames(criterion: &mut Criterion) {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("run");
    let settings = [String::from("evolution.generation_limit=40")];
    let scenario = Scenario::load("environment-3")
        .unwrap()
        .with_settings(&settings)
        .unwrap();
    start(scenario.clone(), 1, &folder, &RunOptions::default())
        .unwrap()
        .join()
        .unwrap();
    let experiment = lasting_experiment(scenario, 1).unwrap();
    let look = Look::new(Theme::all(), "dark", Signs::of(Glyphs::Unicode));
    let folder_name = String::from("run");
    let context = ViewContext::new(
        experiment,
        folder_name,
        Mode::Replay,
        look,
        KeyMap::default(),
    );
    let app = App::new(context);
    let mut dashboard = OffscreenDashboard::new(app, Archive::new(experiment, &folder, None));
    dashboard.update(Input::Resize(200, 60));
    for event in Recording::read(&folder).unwrap().events {
        dashboard.update(Input::Event(Box::new(event)));
    }
    for view in ViewId::all() {
        dashboard.open(view);
        for _ in 0..50 {
            dashboard.update(Input::Tick(Duration::from_millis(100)));
        }
        let mut buffer = Buffer::empty(Rect::new(0, 0, 200, 60));
        criterion.bench_function(&format!("{} at 200x60", view.name()), |bencher| {
            bencher.iter(|| {
                buffer.reset();
                dashboard.app().draw_on(black_box(&mut buffer));
            });
        });
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
