"""Exact wording of the statement of each kind of certificate; any other is rejected."""

FORMAT = "flockana certificate 1"
BASIN = (
    "In the frame of the centre of mass, every solution that starts nearer than `radius` to the orbit under rotations "
    "of the equilibrium that lies within `box` of `positions` in each coordinate (distance over all coordinates, "
    "agents numbered), with a structural energy less than `level` above the equilibrium's, converges to a point of "
    "that orbit with matched velocities; E(t) <= overshoot E(0) exp(-2 rate t), U - U* >= curvature/2 times the "
    "squared distance, and no two agents come nearer than `distance`."
)
BASIN_PROSE = (
    "U and H do not change under rotations, so what holds along w orthogonal to the tangent at x* holds at every R x*.",
    "At the nearest point of the orbit the displacement is orthogonal to its tangent, and |w_j - w_i| <= sqrt(2) |w|.",
    "U is twice continuously differentiable: the bump is C^1, so that phi_alpha is C^1 and psi_alpha is C^2.",
    "Half the squared distance to the orbit has the gradient w and a Hessian that is at most 1, and is smooth where "
    "the nearest point is unique and not degenerate: what is checked suffices for that.",
    "The energy's excess E falls at the rate of the damping, by the law; F > 0 with dF/dt <= -2 rate F on an invariant "
    "set falls like exp(-2 rate t); the speed is then integrable in time, and the places converge.",
)
TUBE = (
    "The solution from q0, p0 differs from the path of polynomials at no time of a step by more than its error, in the "
    "norm sqrt(weight^2 |q|^2 + |p|^2); no two agents come nearer than `distance`, and none is farther than "
    "`cohesion_radius` from the centre of mass, or nearer than `clearance` to a sphere, if there is one. If there is a "
    "basin, the end lies in it, turned by `turn`, and the run converges to its orbit. The law is the one whose numbers "
    "stand here, decimals as they are written."
)
TUBE_PROSE = (
    "f is C^1, with a derivative that is Lipschitz: the bump is C^1; so u is the integral of its slope along a path.",
    "An error e of two solutions obeys d|e|/dt <= mu |e| + |defect| while mu bounds the logarithmic norm between them.",
    "A bound that holds strictly as long as it holds, holds to the end of the step.",
)
STATEMENTS = {"basin": (BASIN, BASIN_PROSE), "tube": (TUBE, TUBE_PROSE)}
