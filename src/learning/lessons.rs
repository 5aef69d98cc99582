//! Learning in an agent: Algorithm 2.4, lines 12 to 22, when a child has returned.

use super::agent::{Agent, Frame};
use super::linear::Replay;
use super::observe::{Observer, Update};
use super::state_values::{Completion, Parameters};
use crate::scenario::{CompletionBootstrap, CoolOn, LearningSettings, PseudoReward};
use crate::worlds::{StateType, World};

impl<W: World> Agent<'_, W> {
    /// Algorithm 2.4, lines 12 to 22, from the innermost active subtask up to the first
    /// that goes on.
    pub(super) fn ascend(&mut self, truncated: bool, observer: &mut impl Observer<W>) {
        while let Some(&frame) = self.stack.last() {
            let terminal = !self
                .parameters
                .plan
                .can_act(frame.node, self.now.state_type);
            self.learn(frame, terminal, observer);
            if self.stack.len() == 1 {
                self.visited.clear();
            }
            if !terminal && !truncated {
                return;
            }
            if terminal {
                self.cool(frame.node, observer);
            }
            self.stack.pop();
        }
    }

    /// Lines 13 to 19: updates C~ and C of the child that returned, for all states
    /// visited meanwhile, the most recent first.
    ///
    /// The bootstrap values are computed once, before the first update.
    fn learn(&mut self, frame: Frame, terminal: bool, observer: &mut impl Observer<W>) {
        let Frame {
            node,
            child,
            started,
        } = frame;
        let parameters = &mut self.parameters;
        let pseudo_reward = pseudo_reward(
            self.settings,
            parameters.plan.nodes[node]
                .goal
                .contains(self.now.state_type),
            terminal,
        );
        let (mut inside, mut outside, mut best) = (0.0, 0.0, None);
        if !terminal {
            let (a_star, projected) = parameters.best_child(&mut self.now, node);
            inside = parameters.completion(&mut self.now, node, a_star, Completion::Inside);
            outside =
                projected + parameters.completion(&mut self.now, node, a_star, Completion::Outside);
            match self.settings.completion_bootstrap {
                CompletionBootstrap::NextState => inside += projected,
                CompletionBootstrap::AsPrinted => best = Some(a_star),
            }
        }
        inside += pseudo_reward;
        let map = parameters.plan.nodes[child].completion.map;
        if parameters.plan.nodes[child].primitive.is_some() {
            let before = &mut self.before;
            let state_type = before.state_type;
            if let Some(a_star) = best.filter(|&a| parameters.plan.can_act(a, state_type)) {
                inside += parameters.projected_value(before, a_star);
            }
            let features = parameters.encoder.encode(map, &mut before.features);
            let lesson = Lesson {
                state_type,
                features,
                steps: 1,
                discounts: &self.discounts[1..2],
                targets: [inside, outside],
                learning_rate: self.settings.learning_rate as f32,
            };
            parameters.study(node, child, lesson, observer);
        } else {
            let states = self.visited.types.len();
            let mut end = states;
            while end > started {
                let state_type = self.visited.types[end - 1];
                let alike = self.visited.types[started..end].iter().rev();
                let mut begin = end - alike.take_while(|&&t| t == state_type).count();
                let mut inside = inside;
                if let Some(a_star) = best {
                    // The bootstrap value is another one in each state.
                    begin = end - 1;
                    if parameters.plan.can_act(a_star, state_type)
                        && let Some(percepts) = &self.visited.percepts
                    {
                        self.before.load(state_type, percepts[begin].as_ref());
                        inside += parameters.projected_value(&mut self.before, a_star);
                    }
                }
                let steps = states - end + 1;
                let lesson = Lesson {
                    state_type,
                    features: self.visited.features(map, begin..end),
                    steps,
                    discounts: &self.discounts[steps..=states - begin],
                    targets: [inside, outside],
                    learning_rate: self.settings.learning_rate as f32,
                };
                parameters.study(node, child, lesson, observer);
                end = begin;
            }
        }
        self.now.forget(&self.parameters.plan, child);
    }

    /// The temperature falls after line 22, never below its limit (Thesis 3.1).
    fn cool(&mut self, node: usize, observer: &mut impl Observer<W>) {
        let at_goal = self.parameters.plan.nodes[node]
            .goal
            .contains(self.now.state_type);
        observer.terminated(node, at_goal);
        if self.settings.cool_on == CoolOn::Goal && !at_goal {
            return;
        }
        if let Some(values) = &mut self.parameters.values[node] {
            let cooled = values.temperature * self.settings.temperature_decrease as f32;
            values.temperature = cooled.max(self.settings.temperature_limit as f32);
        }
    }
}

/// The pseudo-reward of a transition (Thesis Definition 2.1): 0 into a goal state, minus
/// the penalty into another terminal state; under `all`, into every state that is no goal.
pub(super) fn pseudo_reward(settings: &LearningSettings, at_goal: bool, terminal: bool) -> f32 {
    let punished = !at_goal && (terminal || settings.pseudo_reward == PseudoReward::All);
    if punished {
        -settings.pseudo_penalty as f32
    } else {
        0.0
    }
}

/// What is to be learned in successive states of one type.
struct Lesson<'a> {
    state_type: StateType,
    /// Of the completion functions' map, the most recent state last.
    features: &'a [f32],
    /// N in the most recent state.
    steps: usize,
    /// gamma^N, the most recent state first.
    discounts: &'a [f32],
    /// What C~ and C are to be where N = 0.
    targets: [f32; 2],
    learning_rate: f32,
}

impl Parameters<'_> {
    /// Updates C~ and C of a composite node for a child.
    #[inline(always)]
    fn study<W: World>(
        &mut self,
        node: usize,
        child: usize,
        lesson: Lesson<'_>,
        observer: &mut impl Observer<W>,
    ) {
        let Some(values) = &mut self.values[node] else {
            return;
        };
        let plan = &self.plan.nodes[child].completion;
        let at = self.plan.block(child, lesson.state_type);
        let (first, second) = values.parameters[at..].split_at_mut(plan.vector);
        let replay = Replay {
            parameters: [&mut first[..plan.stride], &mut second[..plan.stride]],
            features: lesson.features,
            discounts: lesson.discounts,
            targets: lesson.targets,
            learning_rate: lesson.learning_rate,
            watch: |recent, [error_inside, error_outside]: [f32; 2]| {
                observer.updated(Update {
                    node,
                    child,
                    state_type: lesson.state_type,
                    steps: lesson.steps + recent,
                    error_inside,
                    error_outside,
                });
            },
        };
        replay.run();
    }
}
