# %% Compares two oils: where does the one lose less, and why?
# Plots to the file that the first argument names. Needs pandas and matplotlib.
import sys

import matplotlib.pyplot as plt

import tribodyn

client = tribodyn.Client()
oils = ["paper-fluid-1", "paper-fluid-2"]

# %% The curves, computed together
curves = client.compare(
    oils, speeds_kilometres_per_hour=range(20, 141, 10), sump_temperature_celsius=90
)

# %% Loss at each speed
by_speed = curves.pivot(
    index="speed_kilometres_per_hour", columns="lubricant", values="mesh_loss_power_watts"
)
by_speed["saved_watts"] = by_speed[oils[0]] - by_speed[oils[1]]
print(by_speed.round(1))

# %% Inefficiency with its estimated error, and the film that carries the load
figure, (above, below) = plt.subplots(2, 1, sharex=True)
for oil, curve in curves.groupby("lubricant"):
    speed = curve["speed_kilometres_per_hour"]
    inefficiency = curve["inefficiency_energy_mean_percent"]
    above.errorbar(speed, inefficiency, inefficiency * curve["estimated_relative_error"], label=oil)
    below.plot(speed, curve["film_ratio_mean"], label=oil)
above.set_ylabel("mesh inefficiency, %")
above.legend()
below.set_ylabel("film ratio")
below.set_xlabel("speed, km/h")
result = curves.attrs["results"][oils[0]]
figure.suptitle(f"{result['model_version']}, inputs {result['input_hash'][:12]}")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "compare_two_oils.svg")
