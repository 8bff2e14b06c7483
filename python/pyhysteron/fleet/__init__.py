"""Fleets: a model for each of many actuators, from one call to one table.

`fit_fleet` writes a table with a row for each actuator, as ``hysteron fleet fit`` does.
`read_fleet` reads its models, `join_fleets` puts tables of parts together, and `prior_of_fleet`
(or a `WeightPrior` of models at hand) tells what they say about the next actuator.

`pyhysteron.fleet.spark` and `pyhysteron.fleet.dask` fit frames of samples on several machines, and
`pyhysteron.fleet.dask` also fits tables in files. They need the extras ``spark`` and ``dask``.
"""

from .._hysteron import WeightPrior, fit_fleet, join_fleets, prior_of_fleet, read_fleet

__all__ = ["WeightPrior", "fit_fleet", "join_fleets", "prior_of_fleet", "read_fleet"]
