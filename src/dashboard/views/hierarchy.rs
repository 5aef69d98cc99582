//! The task hierarchy.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::{View, nothing_yet, origin};
use crate::dashboard::desk::Desk;
use crate::dashboard::input::Effect;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, fitted, one_line, put, width, wrapped};
use crate::evolution::{Origin, RankedRecord};
use crate::hierarchy::{Tree, draw, to_dot};

/// The task hierarchy of the individual that is looked at, its active path lit.
///
/// ```text
///  ╭ Hierarchy  individual 362, rank 1 ──────────────────╮
///  │   subtask              types     T  invoked         │
///  │ ▸ Root                 1234  0.050       12         │
///  │   ├─ FindBattery       1     0.050       12         │
///  │   │  └─ Avoid          1234            1201         │
///  │ ▸ └─ ApproachBattery    2               310         │
///  │                                                     │
///  │ made by crossover: ...                              │
///  ╰─────────────────────────────────────────────────────╯
/// ```
#[derive(Default)]
pub(super) struct Hierarchy {
    /// Lines above the screen.
    scroll: usize,
}

impl View for Hierarchy {
    fn caption(&self, desk: &Desk) -> String {
        let looked_at = desk.looked_at();
        looked_at.map_or(String::new(), |(generation, individual)| {
            let separator = desk.look.signs.separator;
            let (id, rank) = (individual.id, individual.rank);
            format!("id {id}, gen {generation} {separator} rank {rank}")
        })
    }

    fn draw(&self, desk: &Desk, area: Rect, buffer: &mut Buffer) {
        let Some((_, individual)) = desk.looked_at() else {
            return nothing_yet(desk, area, buffer);
        };
        let look = &desk.look;
        let Some(tree) = desk.tree(individual) else {
            let text = fitted(
                &one_line(&individual.tree),
                usize::from(area.width),
                look.signs,
            );
            put(buffer, area, (1, 0), &text, look.style(Paint::Bad));
            return;
        };
        let nodes = tree.nodes().len();
        let room = usize::from(area.height.saturating_sub(1));
        let skipped = self.scroll.min(nodes.saturating_sub(room));
        let table = Table::of(desk, individual, &tree, area.width);
        table.draw_head(desk, area, buffer);
        let below = Rect {
            y: area.y + 1.min(area.height),
            height: area.height.saturating_sub(1),
            ..area
        };
        for (row, node) in (skipped..nodes).take(room).enumerate() {
            table.draw_node(desk, &tree, node, row as u16, below, buffer);
        }
        let rest = Rect {
            y: below.y + (nodes as u16 + 1).min(below.height),
            height: below.height.saturating_sub(nodes as u16 + 1),
            ..below
        };
        draw_story(desk, individual, rest, buffer);
    }

    fn hints(&self) -> &'static [Action] {
        &[Action::Halt, Action::StepRollout, Action::Best]
    }

    fn act(&mut self, desk: &mut Desk, action: Action) -> Option<Vec<Effect>> {
        let individual = desk.looked_at();
        let tree = individual.and_then(|(_, individual)| desk.tree(individual));
        let last = tree.map_or(0, |tree| tree.nodes().len()).saturating_sub(1);
        let page = usize::from(desk.size.1 / 2);
        let here = self.scroll.min(last);
        self.scroll = match action {
            Action::Up => here.saturating_sub(1),
            Action::Down => here + 1,
            Action::PageUp => here.saturating_sub(page),
            Action::PageDown => here + page,
            Action::Top => 0,
            Action::Bottom => last,
            _ => return None,
        };
        self.scroll = self.scroll.min(last);
        Some(Vec::new())
    }

    fn csv(&self, desk: &Desk) -> Option<String> {
        let (_, individual) = desk.looked_at()?;
        let tree = desk.tree(individual)?;
        let table = Table::of(desk, individual, &tree, u16::MAX);
        let mut csv = String::from("node,parent,subtask,state_types,temperature,invoked\n");
        for (index, node) in tree.nodes().iter().enumerate() {
            let parent = node
                .parent
                .map(|parent| parent.to_string())
                .unwrap_or_default();
            let subtask = desk.catalogue().subtask(node.subtask);
            let types = subtask.active.to_string().replace(',', " ");
            let [temperature, visits] = table.numbers(index);
            csv.push_str(&format!(
                "{index},{parent},{},{types},{temperature},{visits}\n",
                subtask.name
            ));
        }
        Some(csv)
    }

    fn dot(&self, desk: &Desk) -> Option<String> {
        let tree = desk.tree(desk.looked_at()?.1)?;
        Some(to_dot(&tree, desk.catalogue()))
    }

    fn lesson(&self) -> &'static str {
        "The task hierarchy of an individual, its genome. Root and the other composite subtasks\n\
         (bold) choose among their children until they terminate; primitive subtasks act. Lit is\n\
         the path from root to action in the rollout. State types: in which a subtask can be\n\
         active (Thesis Tables 4.2, 4.3). T: temperature of a composite's softmax; it falls\n\
         whenever the subtask terminates, and choices become greedy. invoked: in this rollout."
    }
}

/// Columns of a temperature and of a count.
const TEMPERATURE: u16 = 6;
const INVOKED: u16 = 8;

/// What is told of each node, and where.
struct Table {
    lines: Vec<String>,
    /// Columns of state types, temperature and count; `None` where there is no room. What
    /// never changes gives way first.
    types: Option<u16>,
    temperature: Option<u16>,
    invoked: Option<u16>,
    temperatures: Vec<Option<f32>>,
    visits: Vec<u64>,
    path: Vec<usize>,
}

impl Table {
    fn of(desk: &Desk, individual: &RankedRecord, tree: &Tree, columns: u16) -> Self {
        let lines = draw(tree, desk.catalogue(), desk.look.signs.tree);
        let names = lines.iter().map(|line| width(line)).max().unwrap_or(0);
        let first = u16::try_from(names).unwrap_or(u16::MAX).saturating_add(4);
        let types = first.saturating_add(desk.catalogue().state_types.len().max(5) as u16 + 1);
        let all = types.saturating_add(TEMPERATURE + INVOKED) <= columns;
        let after = if all { types } else { first };
        let on_stage = desk
            .stage
            .subject()
            .is_some_and(|subject| subject.id == individual.id);
        let rollout = desk.stage.rollout().filter(|_| on_stage);
        Self {
            lines,
            types: all.then_some(first),
            temperature: Some(after).filter(|column| column.saturating_add(TEMPERATURE) <= columns),
            invoked: Some(after.saturating_add(TEMPERATURE))
                .filter(|column| column.saturating_add(INVOKED) <= columns),
            temperatures: rollout
                .map(|rollout| rollout.temperatures())
                .unwrap_or_default(),
            visits: rollout
                .map(|rollout| rollout.status().visits.clone())
                .unwrap_or_default(),
            path: rollout
                .map(|rollout| rollout.status().path.clone())
                .unwrap_or_default(),
        }
    }

    /// Temperature and number of invocations of a node, as far as they are known.
    fn numbers(&self, node: usize) -> [String; 2] {
        let temperature = self.temperatures.get(node).copied().flatten();
        [
            temperature
                .map(|temperature| format!("{temperature:.3}"))
                .unwrap_or_default(),
            self.visits
                .get(node)
                .map(ToString::to_string)
                .unwrap_or_default(),
        ]
    }

    fn draw_head(&self, desk: &Desk, area: Rect, buffer: &mut Buffer) {
        let dim = desk.look.style(Paint::Dim);
        put(buffer, area, (2, 0), "subtask", dim);
        if let Some(column) = self.types {
            put(buffer, area, (column, 0), "types", dim);
        }
        if let Some(column) = self.temperature {
            put(buffer, area, (column + 4, 0), "T", dim);
        }
        if let Some(column) = self.invoked {
            put(buffer, area, (column, 0), " invoked", dim);
        }
    }

    fn draw_node(
        &self,
        desk: &Desk,
        tree: &Tree,
        node: usize,
        row: u16,
        area: Rect,
        buffer: &mut Buffer,
    ) {
        let (look, catalogue) = (&desk.look, desk.catalogue());
        let subtask = catalogue.subtask(tree.subtask(node));
        let lit = self.path.contains(&node);
        let dim = look.style(Paint::Dim);
        let line = self.lines.get(node).map_or("", |line| line);
        let branches = width(line).saturating_sub(width(subtask.name));
        let branches: String = line.chars().take(branches).collect();
        if lit {
            put(
                buffer,
                area,
                (0, row),
                look.signs.pointer,
                look.style(Paint::Key),
            );
        }
        let column = put(buffer, area, (2, row), &branches, look.style(Paint::Border));
        let paint = match (lit, subtask.is_composite()) {
            (true, _) => Paint::Active,
            (false, true) => Paint::Title,
            (false, false) => Paint::Text,
        };
        put(buffer, area, (column, row), subtask.name, look.style(paint));
        if let Some(column) = self.types {
            let types =
                catalogue
                    .types()
                    .map(|state_type| match subtask.active.contains(state_type) {
                        true => state_type.number().to_string(),
                        false => String::from(" "),
                    });
            let types: String = types.collect();
            put(buffer, area, (column, row), &types, dim);
        }
        let [temperature, invoked] = self.numbers(node);
        if let Some(column) = self.temperature {
            put(
                buffer,
                area,
                (column, row),
                &format!("{temperature:>5}"),
                dim,
            );
        }
        if let Some(column) = self.invoked {
            put(
                buffer,
                area,
                (column, row),
                &format!("{invoked:>8}"),
                look.style(Paint::Text),
            );
        }
    }
}

/// Below the tree: where the individual comes from and how it did.
fn draw_story(desk: &Desk, individual: &RankedRecord, area: Rect, buffer: &mut Buffer) {
    let look = &desk.look;
    let room = usize::from(area.width.saturating_sub(3));
    let lines = story(individual).into_iter().flat_map(|(text, paint)| {
        let lines = wrapped(&one_line(&text), room, "  ");
        lines.into_iter().map(move |line| (line, paint))
    });
    for (row, (text, paint)) in (0..area.height).zip(lines) {
        put(buffer, area, (2, row), &text, look.style(paint));
    }
}

fn story(individual: &RankedRecord) -> Vec<(String, Paint)> {
    let steps: Vec<_> = individual
        .trials
        .iter()
        .map(|trial| match trial.delivered {
            true => trial.steps.to_string(),
            false => format!("{}!", trial.steps),
        })
        .collect();
    let mut story = vec![(format!("scored trials {}", steps.join(" ")), Paint::Text)];
    match &individual.origin {
        Origin::Crossover {
            receiver,
            donor,
            inherited,
            reset,
        } => {
            let made = format!(
                "made of {} by putting {}'s {} in the place of {}",
                receiver.id, donor.id, donor.subtask, receiver.subtask
            );
            let kept: Vec<_> = inherited
                .iter()
                .map(|kept| format!("{} from {}", kept.subtask, kept.from))
                .collect();
            story.push((made, Paint::Text));
            story.push((format!("inherited: {}", listed(&kept)), Paint::Good));
            story.push((format!("set back: {}", listed(reset)), Paint::Notice));
        }
        other => story.push((origin(other), Paint::Text)),
    }
    story
}

fn listed(names: &[String]) -> String {
    match names {
        [] => String::from("nothing"),
        names => names.join(", "),
    }
}
