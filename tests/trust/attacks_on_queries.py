"""Attacks by questions in SQL to a dataset."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from attack import Attack, Ground

from hearth.datasets.dataset import Dataset

QUERIES = (
    "COPY (SELECT 1) TO '{part}'", "COPY (SELECT 1) TO '{guard}/x.csv'",
    "COPY programs TO '{part}' (USE_TMP_FILE false)",
    "EXPLAIN ANALYZE COPY (SELECT 1) TO '{part}'", "EXPLAIN ANALYZE COPY (SELECT 1) TO '{guard}/secret.csv'",
    "EXPLAIN (ANALYZE) COPY (SELECT 1) TO '{part}'", "EXPLAIN (ANALYZE, FORMAT json) COPY (SELECT 1) TO '{part}'",
    "explain/**/analyze/*\u00e9*/copy (select 1) to '{part}'", "-- a\nEXPLAIN ANALYZE\nCOPY (SELECT 1) TO '{part}'",
    "WITH x AS (COPY (SELECT 1) TO '{part}') FROM x", "EXPLAIN ANALYZE WITH x AS (COPY (SELECT 1) TO '{part}') FROM x",
    "WITH x AS (COPY (SELECT 1) TO '{dataset}/new.parquet') SELECT 1",
    "FROM (WITH x AS (COPY (SELECT 1) TO '{part}') FROM x)", "FROM query($$COPY (SELECT 1) TO '{part}'$$)",
    "FROM query('WITH x AS (COPY (SELECT 1) TO ''{part}'') FROM x')", "SELECT 1) AS a; COPY (SELECT 1) TO '{part}'; --",
    "SELECT 1; COPY (SELECT 1) TO '{part}'", "PREPARE x AS COPY (SELECT 1) TO '{part}'", "EXECUTE x",
    "EXPORT DATABASE '{dataset}/programs'", "EXPORT DATABASE '{guard}/new'", "IMPORT DATABASE '{guard}'",
    "ATTACH '{guard}/x.duckdb' AS x", "ATTACH '{dataset}/x.duckdb' AS x", "DETACH memory", "USE memory",
    "CREATE TABLE x AS SELECT 1", "CREATE OR REPLACE VIEW programs AS SELECT 1", "DROP VIEW programs",
    "EXPLAIN ANALYZE DROP VIEW programs", "EXPLAIN ANALYZE CREATE TABLE x AS SELECT 1", "DELETE FROM programs",
    "SET enable_external_access = true", "SET allowed_directories = ['/']", "RESET lock_configuration",
    "PRAGMA enable_external_access", "SET VARIABLE x = 1", "INSTALL httpfs", "LOAD '{guard}/secret.csv'", "LOAD httpfs",
    "CALL enable_logging()", "CHECKPOINT", "VACUUM", "BEGIN", "FROM read_text('{guard}/secret.csv')",
    "FROM read_csv('{guard}/secret.csv')", "FROM '{guard}/secret.csv'", "FROM read_blob('{guard}/secret.csv')",
    "FROM glob('{guard}/*')", "FROM read_text('{dataset}/../guard/secret.csv')", "FROM sniff_csv('{guard}/secret.csv')",
    "FROM read_text('{dataset}/link')", "FROM read_json('{guard}/secret.csv')", "SELECT getenv('HOME')",
    "FROM read_parquet('http://127.0.0.1:9/x.parquet')", "FROM 's3://nowhere/x.parquet'", "FROM duckdb_secrets()",
    "FROM sql_auto_complete('SEL')", "FROM QUERIES", "FROM sys", "SELECT '", "EXPLAIN", "EXPLAIN ANALYZE", "", ";",
)  # fmt: skip


def queries() -> Iterator[Attack]:
    """Questions that would write, read elsewhere, or open what is closed."""

    def ask(query: str, ground: Ground) -> Any:
        (ground.dataset / "link").unlink(missing_ok=True)
        part = next((ground.dataset / "programs").glob("*.parquet"))
        words = {"part": part, "guard": ground.guard, "dataset": ground.dataset}
        text = query
        for name, value in words.items():
            text = text.replace(f"{{{name}}}", str(value))
        return Dataset.open(ground.dataset).rows(text)

    for query in QUERIES:
        yield Attack("sql", query[:60], lambda ground, query=query: ask(query, ground))
