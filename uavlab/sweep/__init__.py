"""The same function over many cases: on one core, on many, or on a cluster; what is done is kept.

joblib does the work: where it runs is for the caller to say, `with joblib.parallel_config("dask"): sweep(…)`, and the
results don't depend on it, because each case brings its own seed. A case that fails, and a worker that dies, cost
that case; a file takes the results as they come, and a second call goes on from it.
"""

from uavlab.sweep.failure import Failure, UnpicklableError, WorkerLostError
from uavlab.sweep.sweep import sweep

__all__ = ["Failure", "UnpicklableError", "WorkerLostError", "sweep"]
