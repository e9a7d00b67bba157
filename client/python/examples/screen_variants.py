# %% Screens variants of an oil and a surface as a campaign: which is best, and what does it cost?
# Runs again where it was interrupted: the server keeps what it has computed. Needs pandas.
import numpy as np
import pandas

import tribodyn

client = tribodyn.Client()

# %% The variants: two additives in several concentrations, with what their rigs and suppliers say
grid = pandas.MultiIndex.from_product([["A", "B"], np.linspace(0, 2, 9)]).to_frame(index=False)
grid.columns = ["additive", "concentration_percent"]
share = grid["concentration_percent"] / 2
is_b = grid["additive"] == "B"
grid["name"] = grid["additive"] + "-" + grid["concentration_percent"].astype(str)
grid["cost"] = 10 + share * np.where(is_b, 6, 3)
grid["surface.asperity_friction_coefficient"] = 0.12 - share * np.where(is_b, 0.05, 0.03)
grid["lubricant.relaxation_time"] = [f"{ns} ns" for ns in 400 * (1 + 0.2 * share)]

# %% The campaign: every variant at every speed and sump temperature
campaign = client.screen(
    grid,
    "paper-fluid-1",
    speeds_kilometres_per_hour=[20, 40, 60, 80],
    speed_weights=[1, 2, 2, 1],
    sump_temperatures_celsius=[40, 90],
    display_name="two additives",
)
campaign.wait()

# %% The ranking, and the best variant at each cost
ranking = campaign.ranking()
print(ranking[["name", "cost", "inefficiency_energy_mean_percent", "status"]].head())
by_cost = ranking.sort_values("cost")
best = by_cost[
    by_cost["inefficiency_energy_mean_percent"]
    == by_cost["inefficiency_energy_mean_percent"].cummin()
]
print(best[["name", "cost", "inefficiency_energy_mean_percent"]])

# %% The effect of each additive at each condition, per percent of concentration
points = campaign.frame()
for additive, group in points.groupby("additive"):
    effect = group.groupby(["sump_temperature_celsius", "speed_kilometres_per_hour"]).apply(
        lambda rows: np.polyfit(rows["concentration_percent"], rows["mesh_loss_power_watts"], 1)[0]
    )
    print(f"{additive}: W of mesh loss per percent\n{effect.round(2)}")
