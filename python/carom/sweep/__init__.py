"""Sweeps: many shots of one scene with drawn values, as a table, on one machine or on many.

The draws are as in `carom sweep`: a value depends only on the seed, the number of the shot and the key.

`columns` and `table` play shots at once. For a sweep that is too large for that, make a `plan`: its shards
are Parquet files in a folder, each complete or absent, and the folder is the only state. `run` makes the
missing shards in this process or with Dask; it may be killed at any time and run again. `status` lists the
shards, `check` reads all of them, and `open` returns them as a dataset. `reduce` keeps only the results of a
function of the rows.

    python -m carom.sweep --help
"""

from carom.sweep._columns import columns, table
from carom.sweep._plan import Plan, SweepError, plan
from carom.sweep._shards import Run, Status, check, open, reduce, run, run_shard, status

__all__ = ["Plan", "Run", "Status", "SweepError", "check", "columns", "open", "plan", "reduce",
           "run", "run_shard", "status", "table"]
