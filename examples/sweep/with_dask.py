"""The same study by Dask, each case a task: ``python with_dask.py``. On a cluster give its client to `study`."""

from itertools import product

import pandas
from dask.distributed import Client, LocalCluster

import tabor


def pull_off(rms_slope: float, seed: int, scene: str = "rough.toml") -> dict[str, float]:
    """Pressed on and pulled off: the greatest force that holds, N, to 1 %."""
    contact = tabor.Scene.read(scene, {"surface.0.rms_slope": rms_slope, "surface.0.seed": seed}, threads=1)
    # The last load is beyond any that holds; the search goes back from it.
    *_, last = contact.path(pressure=["1 MPa", 0.0, "-10 MPa"])
    return {"rms_slope": rms_slope, "seed": seed, "pull_off_force": last.pull_off[0]}


def study(client: Client, rms_slopes: list[float], seeds: list[int]) -> pandas.DataFrame:
    """One row a case; of a case that failed the reason."""
    cases = list(product(rms_slopes, seeds))
    futures = client.map(lambda case: pull_off(*case), cases)
    rows = []
    for (rms_slope, seed), future in zip(cases, futures):
        failure = future.exception()
        if failure is None:
            rows.append(future.result())
        else:
            rows.append({"rms_slope": rms_slope, "seed": seed, "message": str(failure)})
    return pandas.DataFrame(rows)


if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1) as cluster, Client(cluster) as client:
        table = study(client, [0.05, 0.1, 0.2], [1, 2, 3, 4])
    print(table.groupby("rms_slope")["pull_off_force"].agg(["mean", "std", "count"]))
