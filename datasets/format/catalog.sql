-- Open catalog.duckdb by its path, from any folder; attached, copied or renamed, first SET file_search_path = 'FOLDER';
-- These are the views and macros over a dataset's Parquet files, with a comment for each, for all columns and for all
-- nested fields: SELECT table_name, column_name, comment FROM duckdb_columns() WHERE NOT internal;

CREATE MACRO dataset_folder() AS {folder};

CREATE VIEW activities AS SELECT * FROM read_parquet(dataset_folder() || 'activities/*.parquet');
CREATE VIEW descriptions AS SELECT * FROM read_parquet(dataset_folder() || 'descriptions/*.parquet');
CREATE VIEW programs AS SELECT * FROM read_parquet(dataset_folder() || 'programs/*.parquet');
CREATE VIEW homes AS SELECT * FROM read_parquet(dataset_folder() || 'homes/*.parquet');
CREATE VIEW home_nodes AS SELECT * FROM read_parquet(dataset_folder() || 'home_nodes/*.parquet');
CREATE VIEW home_edges AS SELECT * FROM read_parquet(dataset_folder() || 'home_edges/*.parquet');
CREATE VIEW environments AS SELECT * FROM read_parquet(dataset_folder() || 'environments/*.parquet');
CREATE VIEW executions AS SELECT * FROM read_parquet(dataset_folder() || 'executions/*.parquet');
CREATE VIEW perturbations AS SELECT * FROM read_parquet(dataset_folder() || 'perturbations/*.parquet');
CREATE VIEW repairs AS SELECT * FROM read_parquet(dataset_folder() || 'repairs/*.parquet');
CREATE VIEW splits AS SELECT * FROM read_parquet(dataset_folder() || 'splits/*.parquet');
CREATE VIEW sketches AS SELECT * FROM read_parquet(dataset_folder() || 'sketches/*.parquet');
CREATE VIEW frames AS SELECT * FROM read_parquet(dataset_folder() || 'frames/*.parquet');
CREATE VIEW videos AS SELECT * FROM read_parquet(dataset_folder() || 'videos/*.parquet');
CREATE VIEW clips AS SELECT * FROM read_parquet(dataset_folder() || 'clips/*.parquet');
CREATE VIEW demonstration_frames AS
SELECT * FROM read_parquet(dataset_folder() || 'demonstration_frames/*.parquet');
CREATE VIEW vocabulary AS SELECT * FROM read_parquet(dataset_folder() || 'vocabulary/*.parquet');
CREATE VIEW rejects AS SELECT * FROM read_parquet(dataset_folder() || 'rejects/*.parquet');
CREATE VIEW ledger AS SELECT * FROM read_parquet(dataset_folder() || 'ledger/*.parquet');

CREATE VIEW steps AS
SELECT
    program_id,
    number - 1 AS number,
    step.agent AS agent,
    step.action AS action,
    step.objects[1].name AS object,
    step.objects[1].instance AS object_instance,
    step.objects[2].name AS second_object,
    step.objects[2].instance AS second_object_instance,
    step.joins AS joins,
    step.modifiers AS modifiers,
    origin,
    activity_id
FROM (
    SELECT program_id, origin, activity_id, unnest(steps) AS step, generate_subscripts(steps, 1) AS number
    FROM programs
);

CREATE VIEW ticks AS
SELECT execution_id, program_id, environment_id, home, number - 1 AS number, tick.*
FROM (
    SELECT execution_id, program_id, environment_id, home,
           unnest(ticks) AS tick, generate_subscripts(ticks, 1) AS number
    FROM executions
);

-- One predicate for "perturbed", for the views below and for whoever reads runs.
CREATE MACRO is_perturbed(environment, program) AS EXISTS (
    SELECT 1 FROM (SELECT environment_id AS its_environment, parent_id AS its_program FROM perturbations)
    WHERE its_environment = environment AND its_program = program
);

CREATE VIEW execution_kinds AS
SELECT
    e.execution_id,
    e.program_id,
    e.environment_id,
    e.home,
    CASE
        WHEN is_perturbed(e.environment_id, e.program_id) THEN 'perturbed'
        WHEN p.parent_id IS NOT NULL THEN 'repaired'
        ELSE 'original'
    END AS kind,
    e.executable
FROM executions e LEFT JOIN programs p ON p.program_id = e.program_id;

CREATE VIEW originals AS
SELECT
    e.execution_id,
    p.program_id,
    p.title,
    p.activity_id,
    p.origin,
    e.environment_id,
    e.home,
    e.executable,
    e.failure
FROM executions e JOIN programs p ON p.program_id = e.program_id
WHERE p.parent_id IS NULL AND NOT is_perturbed(e.environment_id, e.program_id);

CREATE MACRO step_text(step) AS
    '[' || step.action || ']'
    || array_to_string(list_transform(step.objects, lambda o: ' <' || o.name || '> (' || o.instance || ')'), '')
    || CASE WHEN len(step.modifiers) = 0 THEN ''
       ELSE ' {{' || array_to_string(list_transform(step.modifiers, lambda m: m.name || '=' || m.value), ' ') || '}}'
       END;

CREATE MACRO steps_text(steps) AS
    array_to_string(
        list_transform(
            steps,
            lambda s, i: CASE WHEN i = 1 THEN '' WHEN s.joins THEN ' | ' ELSE chr(10) END
                || CASE WHEN list_max(list_transform(steps, lambda t: t.agent)) > 0
                   THEN '<char' || s.agent || '> ' ELSE '' END
                || step_text(s)
        ),
        ''
    );

-- Its columns are not called program_id, so that the argument can be a column of that name.
CREATE MACRO program_text(which) AS (
    SELECT steps_text(its_steps)
    FROM (SELECT program_id AS its_id, steps AS its_steps FROM programs)
    WHERE its_id = which
);

-- The semi joins below are for speed: only with them does DuckDB skip row groups without the id.
CREATE MACRO graph_edges(which, after) AS TABLE
WITH run_of AS MATERIALIZED (
    SELECT environment_id, home, ticks FROM executions WHERE execution_id = which
),
case_of AS MATERIALIZED (
    SELECT run_of.home, ticks, added, removed, removed_nodes
    FROM run_of, (SELECT * FROM environments SEMI JOIN run_of USING (environment_id)) v
),
base AS (SELECT * FROM home_edges SEMI JOIN run_of USING (home)),
tick AS (
    SELECT unnest(ticks) AS t, generate_subscripts(ticks, 1) AS number FROM case_of
),
event AS (
    SELECT d.source, d.relation, d.target, 1 AS time, false AS holds FROM (SELECT unnest(removed) AS d FROM case_of)
    UNION ALL SELECT d.source, d.relation, d.target, 2, true FROM (SELECT unnest(added) AS d FROM case_of)
    UNION ALL SELECT d.source, d.relation, d.target, 2 + number, false
    FROM (SELECT unnest(t.removed) AS d, number FROM tick WHERE number <= coalesce(after, number))
    UNION ALL SELECT d.source, d.relation, d.target, 2 + number, true
    FROM (SELECT unnest(t.added) AS d, number FROM tick WHERE number <= coalesce(after, number))
),
-- Of the home's thousands of edges, only the changed ones are read twice.
changed AS MATERIALIZED (
    SELECT source, relation, target, arg_max(holds, time) AS holds FROM event GROUP BY source, relation, target
)
SELECT source, relation, target FROM (
    SELECT source, relation, target FROM base, case_of
    WHERE NOT list_contains(removed_nodes, source) AND NOT list_contains(removed_nodes, target)
) ANTI JOIN changed USING (source, relation, target)
UNION ALL SELECT source, relation, target FROM changed WHERE holds;

CREATE MACRO graph_nodes(which, after) AS TABLE
WITH run_of AS MATERIALIZED (
    SELECT environment_id, home, ticks FROM executions WHERE execution_id = which
),
case_of AS MATERIALIZED (
    SELECT run_of.home, ticks, added_nodes, removed_nodes, set_states, cleared_states
    FROM run_of, (SELECT * FROM environments SEMI JOIN run_of USING (environment_id)) v
),
base AS (SELECT * FROM home_nodes SEMI JOIN run_of USING (home)),
node AS (
    SELECT id, class_name, category, properties, states
    FROM base, case_of
    WHERE NOT list_contains(removed_nodes, id)
    UNION ALL
    SELECT n.id, n.class_name, n.category, n.properties, n.states FROM (SELECT unnest(added_nodes) AS n FROM case_of)
),
tick AS (
    SELECT unnest(ticks) AS t, generate_subscripts(ticks, 1) AS number FROM case_of
),
event AS (
    SELECT id AS node, unnest(states) AS state, 0 AS time, true AS holds FROM node
    UNION ALL SELECT d.node, d.state, 1, false FROM (SELECT unnest(cleared_states) AS d FROM case_of)
    UNION ALL SELECT d.node, d.state, 2, true FROM (SELECT unnest(set_states) AS d FROM case_of)
    UNION ALL SELECT d.node, d.state, 2 + number, false
    FROM (SELECT unnest(t.cleared_states) AS d, number FROM tick WHERE number <= coalesce(after, number))
    UNION ALL SELECT d.node, d.state, 2 + number, true
    FROM (SELECT unnest(t.set_states) AS d, number FROM tick WHERE number <= coalesce(after, number))
),
holding AS (
    SELECT node, state FROM event GROUP BY node, state HAVING arg_max(holds, time)
)
SELECT id, class_name, category, properties, coalesce(now, []) AS states
FROM node LEFT JOIN (SELECT node, list_sort(list(state)) AS now FROM holding GROUP BY node) ON node = id;

CREATE MACRO final_state(which) AS TABLE
SELECT id, class_name, unnest(states) AS state FROM graph_nodes(which, NULL);

-- From counts and differences, without rebuilding graphs.
CREATE VIEW start_relations AS
WITH times AS (
    SELECT environment_id, home, count(*) AS times FROM executions GROUP BY ALL
),
differs AS (
    SELECT times.environment_id, times.home, times, added, removed, removed_nodes
    FROM environments JOIN times USING (environment_id)
),
part AS (
    SELECT relation, n * times AS edges
    FROM (SELECT home, relation, count(*) AS n FROM home_edges GROUP BY ALL)
    JOIN (SELECT home, sum(times) AS times FROM times GROUP BY ALL) USING (home)
    UNION ALL SELECT edge.relation, times FROM (SELECT unnest(added) AS edge, times FROM differs)
    UNION ALL SELECT edge.relation, -times FROM (SELECT unnest(removed) AS edge, times FROM differs)
    UNION ALL
    SELECT relation, -times FROM (
        SELECT DISTINCT environment_id, times, source, relation, target
        FROM (SELECT environment_id, home, times, unnest(removed_nodes) AS node FROM differs) removed_node
        JOIN home_edges ON home_edges.home = removed_node.home AND (source = node OR target = node)
    )
)
SELECT relation, sum(edges)::BIGINT AS edges FROM part GROUP BY relation;
