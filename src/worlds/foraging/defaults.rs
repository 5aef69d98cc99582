//! The defaults of the foraging task with their sources.
//!
//! Where the thesis gives no value, the constant says so.

/// Length of a time step in seconds, Thesis Table 4.5.
pub const TIME_STEP_S: f64 = 0.1;
/// Side of the square arena in millimetres, Thesis 4.3 (3 by 3 m).
pub const ARENA_SIDE_MM: f64 = 3000.0;
/// Radius of the robot's body in millimetres; the thesis does not print it.
pub const ROBOT_RADIUS_MM: f64 = 75.0;
/// Distance between the wheels in millimetres; the thesis does not print it.
pub const WHEEL_BASE_MM: f64 = 150.0;
/// Distance of capture in millimetres, from centre to centre.
pub const CAPTURE_DISTANCE_MM: f64 = 160.0;
/// Distance of delivery in millimetres, from centre to centre.
pub const DELIVERY_DISTANCE_MM: f64 = 200.0;
/// Directions of the proximity sensors, left to right, Thesis 4.1.
pub const PROXIMITY_ANGLES_DEG: [f64; 5] = [90.0, 30.0, 0.0, -30.0, -90.0];
/// Effective range of the proximity sensors in millimetres, Thesis 4.1.
pub const PROXIMITY_RANGE_MM: [f64; 2] = [70.0, 350.0];
/// Half the angle of the field of view in degrees, Thesis 4.1.
pub const VISION_HALF_ANGLE_DEG: f64 = 60.0;
/// Maximum visible distance in millimetres, Thesis 4.1.
pub const VISION_RANGE_MM: f64 = 3500.0;
/// Relative noise of every reading, Thesis 4.1: a reading is multiplied by 1 + u,
/// u uniform between minus and plus this value.
pub const SENSOR_NOISE: f64 = 0.1;
/// Actions of Avoid, (right, left) wheel speeds in mm/s, Thesis Table 4.4.
pub const AVOID_ACTIONS: [[f64; 2]; 5] = [
    [250.0, 150.0],
    [150.0, 250.0],
    [300.0, -300.0],
    [-300.0, 300.0],
    [-200.0, -200.0],
];
/// Actions of Wander, (right, left) wheel speeds in mm/s, Thesis Table 4.4.
pub const WANDER_ACTIONS: [[f64; 2]; 5] = [
    [600.0, 600.0],
    [600.0, 400.0],
    [400.0, 600.0],
    [600.0, 100.0],
    [100.0, 600.0],
];
/// Actions of Approach battery and Approach nest, (right, left) wheel speeds in
/// mm/s, Thesis Table 4.4.
pub const APPROACH_ACTIONS: [[f64; 2]; 5] = [
    [450.0, 450.0],
    [675.0, 225.0],
    [225.0, 675.0],
    [900.0, 0.0],
    [0.0, 900.0],
];
/// Actions of Turn, (right, left) wheel speeds in mm/s, Thesis Table 4.4.
pub const TURN_ACTIONS: [[f64; 2]; 4] = [
    [-100.0, 100.0],
    [100.0, -100.0],
    [-200.0, 200.0],
    [200.0, -200.0],
];
/// Names and (right, left) wheel speeds in mm/s of the commands, each of which is a primitive
/// subtask of one action (Thesis 3.1). The thesis gives no list; these are the movements of
/// Wander, a turn on the spot to either side, and a way back.
pub const COMMANDS: [(&str, [f64; 2]); 8] = [
    ("Forward", [600.0, 600.0]),
    ("Left", [600.0, 400.0]),
    ("Right", [400.0, 600.0]),
    ("HardLeft", [600.0, 100.0]),
    ("HardRight", [100.0, 600.0]),
    ("SpinLeft", [300.0, -300.0]),
    ("SpinRight", [-300.0, 300.0]),
    ("Back", [-300.0, -300.0]),
];
/// Rewards of Avoid's actions, Thesis Eq. 4.1.
pub const AVOID_REWARDS: [f64; 5] = [-0.5, -0.5, -0.75, -0.75, -0.875];
/// Rewards of Wander's actions, Thesis Eq. 4.1.
pub const WANDER_REWARDS: [f64; 5] = [-0.25, -0.45, -0.45, -0.67, -0.67];
/// Reward of a failing primitive subtask, Thesis Eq. 4.1: it fails if a proximity reading is the
/// smallest possible, or if its target is out of sight.
pub const FAILURE_REWARD: f64 = -1.0;
/// Approach: the reward is minus the target's angle over this, Thesis Eq. 4.1.
pub const APPROACH_REWARD_DIVISOR_DEG: f64 = 60.0;
/// Turn: the reward at angle zero, Thesis Eq. 4.1.
pub const TURN_REWARD_OFFSET: f64 = -0.25;
/// Turn: the target's angle is divided by this, Thesis Eq. 4.1.
pub const TURN_REWARD_DIVISOR_DEG: f64 = 80.0;
/// RBF centres per proximity sensor; 2^5 = 32 features, Thesis Table 4.6.
pub const PROXIMITY_CENTRES: usize = 2;
/// RBF centres over the angle in Visible battery and Visible nest; with those over
/// the distance 32 x 5 x 2 = 320 features, Thesis Table 4.6.
pub const ANGLE_CENTRES: usize = 5;
/// RBF centres over the distance in Visible battery and Visible nest.
pub const DISTANCE_CENTRES: usize = 2;
/// RBF centres of Approach battery and Approach nest, Thesis Table 4.6.
pub const APPROACH_CENTRES: usize = 11;
/// RBF centres of Turn, Thesis Table 4.6.
pub const TURN_CENTRES: usize = 7;
/// Training steps of each primitive subtask. The thesis says only that they are
/// trained; at this number the greedy actions have the shape of its Figure 4.3.
pub const TRAINING_STEPS: u32 = 100_000;
/// Steps of a training episode of Avoid and Wander. In episodes of five steps the robot rarely
/// touches a wall, and Wander then learns to push into corners.
pub const EXPLORING_EPISODE_STEPS: u32 = 100;
/// Steps of a training episode of Approach and Turn, which soon lose their targets.
pub const TARGET_EPISODE_STEPS: u32 = 5;
/// Temperature decrease factor of Avoid and Wander, Thesis 4.4. It has an effect only with
/// `softmax` exploration.
pub const EXPLORING_TEMPERATURE_DECREASE: f64 = 0.9995;
/// Temperature decrease factor of Approach and Turn, Thesis 4.4.
pub const TARGET_TEMPERATURE_DECREASE: f64 = 0.995;
