//! What a step really did, counted: what the plan left out shows as zero.

/// Counts over one step, or summed over many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Searches for bodies near each other.
    pub broad_phases: u64,
    /// Bodies moved a whole step at once, in closed form.
    pub flights: u64,
    /// Bodies moved through the small steps of a step.
    pub substepped: u64,
    /// Bodies that were turned with constant spin, as a regular precession, and by integration.
    pub isotropic_turns: u64,
    pub symmetric_turns: u64,
    pub asymmetric_turns: u64,
    /// Pairs asked for the time at which they meet.
    pub impact_searches: u64,
    /// Impacts at one point without friction: one division.
    pub frictionless_impacts: u64,
    /// Impacts at one point whose sliding keeps its line: closed form.
    pub straight_impacts: u64,
    /// Impacts at one point whose sliding direction turns: integrated.
    pub turning_impacts: u64,
    /// Impacts at several points at once.
    pub patch_impacts: u64,
    /// Contact points with a friction row.
    pub friction_points: u64,
    /// Contact points with rolling resistance.
    pub rolling_points: u64,
    /// Bodies through small steps that were solved alone; and directly, in islands. The rest went through sweeps.
    pub lone_bodies: u64,
    pub direct_bodies: u64,
}

impl Work {
    /// Every count with its name in reports.
    #[must_use]
    pub fn counts(&self) -> [(&'static str, u64); 15] {
        [
            ("broad phases", self.broad_phases),
            ("flights", self.flights),
            ("bodies through small steps", self.substepped),
            ("isotropic turns", self.isotropic_turns),
            ("symmetric turns", self.symmetric_turns),
            ("asymmetric turns", self.asymmetric_turns),
            ("impact searches", self.impact_searches),
            ("frictionless impacts", self.frictionless_impacts),
            ("straight impacts", self.straight_impacts),
            ("turning impacts", self.turning_impacts),
            ("patch impacts", self.patch_impacts),
            ("friction points", self.friction_points),
            ("rolling points", self.rolling_points),
            ("bodies solved alone", self.lone_bodies),
            ("bodies solved directly", self.direct_bodies),
        ]
    }

    /// Adds the counts of another step.
    pub fn add(&mut self, other: &Self) {
        self.broad_phases += other.broad_phases;
        self.flights += other.flights;
        self.substepped += other.substepped;
        self.isotropic_turns += other.isotropic_turns;
        self.symmetric_turns += other.symmetric_turns;
        self.asymmetric_turns += other.asymmetric_turns;
        self.impact_searches += other.impact_searches;
        self.frictionless_impacts += other.frictionless_impacts;
        self.straight_impacts += other.straight_impacts;
        self.turning_impacts += other.turning_impacts;
        self.patch_impacts += other.patch_impacts;
        self.friction_points += other.friction_points;
        self.rolling_points += other.rolling_points;
        self.lone_bodies += other.lone_bodies;
        self.direct_bodies += other.direct_bodies;
    }
}
