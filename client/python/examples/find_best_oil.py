# %% Finds the oil that loses least at three speeds, with at least 98 % of the base oil's film.
# An ask-and-tell loop with gradients: each step solves a linear program inside a trust region.
# Needs scipy. Nothing remains on the server.
import numpy as np
from scipy.optimize import linprog

import tribodyn

client = tribodyn.Client()
base = client.lubricants.get("paper-fluid-1")
surface = client.surfaces.get("run-in")
speeds = [40, 80, 120]  # km/h
figures = ["inefficiency_energy_mean_percent", "film_ratio_mean"]

# Parameters, and the factors by which they may differ from the base.
ranges = {
    "lubricant.vogel_viscosity_prefactor_pascal_seconds": (0.95, 1.05),
    "lubricant.pressure_viscosity_coefficient_per_pascal": (0.8, 1.25),
    "lubricant.relaxation_time_seconds": (0.5, 2),
    "lubricant.limiting_shear_stress_at_zero_pressure_pascals": (0.75, 1.33),
    "surface.asperity_friction_coefficient": (0.75, 1.33),
}
paths = list(ranges)
usual = np.array(
    [
        getattr(base if path.startswith("lubricant") else surface, path.split(".")[1])
        for path in paths
    ]
)
low, high = np.log(np.array(list(ranges.values()))).T


def evaluate(points):
    """Returns the figures of some x at all speeds, each an array by x and speed: one call, from which
    nothing remains."""
    rows = [
        {"speed_kilometres_per_hour": speed, **dict(zip(paths, usual * np.exp(x)))}
        for x in points
        for speed in speeds
    ]
    found = client.evaluate(
        rows,
        lubricant=base.name,
        surface=surface.name,
        contact_figures=True,
        elasticities=paths if len(points) == 1 else (),
        elasticity_figures=figures if len(points) == 1 else (),
    )
    assert all(status == "OK" for status in found["status"]), found["status_message"]
    shape = (len(points), len(speeds))
    return lambda name: np.asarray(found[name], dtype=float).reshape(shape)


def objective_and_film(x):
    """Returns the mean inefficiency over the speeds at exp(x) times the base and its gradient, and
    the same of the logarithm of the mean film ratio at the lowest speed. Gradients are exact
    elasticities, and differences at a speed at which the flanks part."""
    at = evaluate([x])
    inefficiency, film = (at(name)[0] for name in figures)
    slopes = [
        np.array([at(f"elasticity.{name}.{path}")[0] for path in paths]) for name in figures
    ]  # of the logarithms, by path and speed
    if np.isnan(slopes).any():
        step = 1e-3
        beside = evaluate([x + sign * step * each for each in np.eye(len(x)) for sign in (1, -1)])
        for slope, name in zip(slopes, figures):
            logarithm = np.log(beside(name))
            differences = (logarithm[0::2] - logarithm[1::2]) / (2 * step)
            slope[np.isnan(slope)] = differences[np.isnan(slope)]
    mean_gradient = (slopes[0] * inefficiency).mean(axis=1)
    return inefficiency.mean(), mean_gradient, np.log(film[0]), slopes[1][:, 0]


class TrustRegionLoop:
    """Minimises a figure under the condition that another one is at least 0."""

    def __init__(self, low, high, start, radius=0.05):
        self.low, self.high, self.radius = low, high, radius
        self.x, self.best = start, None

    def ask(self):
        """Returns the next point."""
        if self.best is None:
            return self.x
        _, gradient, slack, slack_gradient = self.best
        step = linprog(
            gradient,
            A_ub=[-slack_gradient],
            b_ub=[max(slack, 0.0)],
            bounds=list(
                zip(
                    np.maximum(self.low - self.x, -self.radius),
                    np.minimum(self.high - self.x, self.radius),
                )
            ),
        )
        return self.x + step.x

    def tell(self, x, figure, gradient, slack, slack_gradient):
        """Takes what was found at a point: keeps it if it is better, else shrinks the region."""
        is_allowed = slack > -1e-3
        if self.best is None or (is_allowed and figure < self.best[0]):
            self.x, self.best = x, (figure, gradient, slack, slack_gradient)
            self.radius *= 2
        else:
            self.radius /= 4


# %% The loop
start = np.zeros(len(paths))
least_film = objective_and_film(start)[2] + np.log(0.98)
loop = TrustRegionLoop(low, high, start)
for evaluation in range(1, 21):
    x = loop.ask()
    figure, gradient, film, film_gradient = objective_and_film(x)
    loop.tell(x, figure, gradient, film - least_film, film_gradient)
    print(f"{evaluation:2d}: {loop.best[0]:.4f} %")
    if loop.radius < 1e-3:
        break

# %% What it found
print(f"least mean inefficiency: {loop.best[0]:.4f} % after {evaluation} evaluations, with a film")
print(f"of {0.98 * np.exp(loop.best[2]):.3f} of the base's, at these factors:")
for path, factor in zip(paths, np.exp(loop.x)):
    print(f"  {path} {factor:.3f}")
