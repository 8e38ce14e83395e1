"""Batch sizes: how many rows, records or pictures are in memory at a time, for every reader and writer.

A share of the input of `ingest`, whose records are weighed, is `FULL_PARTITION` of `pipelines/ingest.py`.
"""

ROWS_OF_A_GROUP = 512
"""Rows of a row group in the Parquet files of stages and datasets."""

ROWS_READ = 64
"""Rows of our own Parquet files that are read at a time; graphs are large."""

ROWS_OF_STRANGERS = 1_000
"""Rows of other people's Parquet files that are read at a time, where none is large."""

RECORDS_CONVERTED = 64
"""Records whose rows a stage converts to Arrow together, unless it sets another number: graphs are large."""

ROWS_OF_A_PART = 512
"""Rows of a part of a split that wait in memory before they are written."""

ROWS_OF_A_FINAL_TABLE = 4_096
"""Rows of a table that needs all cases, such as `activities`, that are written together."""

DESCRIPTIONS_SORTED = 4_096
"""Descriptions that are rows at a time; otherwise they are columns, of a fifth of the size."""

PICTURES_COPIED = 32
"""Pictures that are in memory while they are copied into the table `frames`."""

PROGRAMS_EXPORTED = 128
"""Programs, or runs, that an exporter reads at a time."""

ROWS_OF_AN_ANSWER = 2_048
"""Rows of the answer to a query that are in memory while they are written, as CSV, JSON or Parquet."""

ENVIRONMENTS_MEASURED = 500
"""Environments of a row group by which the bytes of an environment are measured."""
