# %% Finds the oil that loses least at three speeds, with at least 98 % of the base oil's film.
# An ask-and-tell loop with gradients: each step solves a linear program inside a trust region.
# Needs scipy. The server keeps one trial lubricant with its revisions, for the film.
import numpy as np
from scipy.optimize import linprog

import tribodyn

client = tribodyn.Client()
base = client.lubricants.get("paper-fluid-1")
surface = client.surfaces.get("run-in")
speeds = [40, 80, 120]  # km/h

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


def mean_inefficiency(x):
    """Returns the mean over the speeds at exp(x) times the base, and its gradient by central
    differences: one call, from which nothing remains."""
    step = 1e-3
    moved = [x, *(x + sign * step * each for each in np.eye(len(x)) for sign in (1, -1))]
    rows = [
        {"speed_kilometres_per_hour": speed, **dict(zip(paths, usual * np.exp(each)))}
        for each in moved
        for speed in speeds
    ]
    points = client.evaluate(rows, lubricant=base.name, surface=surface.name)
    assert all(status == "OK" for status in points["status"]), points["status_message"]
    figures = np.asarray(points["inefficiency_energy_mean_percent"])
    means = figures.reshape(len(moved), len(speeds)).mean(axis=1)
    return means[0], (means[1::2] - means[2::2]) / (2 * step)


def log_film_ratio(x):
    """Returns the logarithm of the mean film ratio at the lowest speed, where the film is thinnest,
    and its gradient: exact sensitivities. The surface hardly matters to it."""
    oil = {
        path.split(".")[1]: value
        for path, value in zip(paths, usual * np.exp(x))
        if path.startswith("lubricant")
    }
    client.lubricants.update("trial", **oil)
    found = client.sensitivities("trial", speed_kilometres_per_hour=speeds[0])
    elasticities = dict(zip(found["parameter"], found["elasticity.film_ratio.mean"]))
    names = [
        "vogel_viscosity_prefactor",
        "pressure_viscosity_coefficient",
        "relaxation_time",
        "limiting_shear_stress_at_zero_pressure",
    ]
    gradient = [elasticities[f"lubricant.{name}"] for name in names] + [0.0]
    return np.log(found.attrs["figures"]["film_ratio.mean"]), np.array(gradient)


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
client.lubricants.create("trial", base, derived_from=base.name)
start = np.zeros(len(paths))
least_film = log_film_ratio(start)[0] + np.log(0.98)
loop = TrustRegionLoop(low, high, start)
for evaluation in range(1, 21):
    x = loop.ask()
    film, film_gradient = log_film_ratio(x)
    loop.tell(x, *mean_inefficiency(x), film - least_film, film_gradient)
    print(f"{evaluation:2d}: {loop.best[0]:.4f} %")
    if loop.radius < 1e-3:
        break

# %% What it found
print(f"least mean inefficiency: {loop.best[0]:.4f} % after {evaluation} evaluations, with a film")
print(f"of {0.98 * np.exp(loop.best[2]):.3f} of the base's, at these factors:")
for path, factor in zip(paths, np.exp(loop.x)):
    print(f"  {path} {factor:.3f}")
