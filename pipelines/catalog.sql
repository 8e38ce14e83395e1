-- Views and macros over a dataset's Parquet files. `{root}` is put in front of every path: empty in catalog.duckdb,
-- which finds the files by `file_search_path`; the folder itself where the library opens a dataset.

CREATE VIEW activities AS SELECT * FROM read_parquet('{root}activities/*.parquet');
CREATE VIEW descriptions AS SELECT * FROM read_parquet('{root}descriptions/*.parquet');
CREATE VIEW programs AS SELECT * FROM read_parquet('{root}programs/*.parquet');
CREATE VIEW homes AS SELECT * FROM read_parquet('{root}homes/*.parquet');
CREATE VIEW home_nodes AS SELECT * FROM read_parquet('{root}home_nodes/*.parquet');
CREATE VIEW home_edges AS SELECT * FROM read_parquet('{root}home_edges/*.parquet');
CREATE VIEW environments AS SELECT * FROM read_parquet('{root}environments/*.parquet');
CREATE VIEW executions AS SELECT * FROM read_parquet('{root}executions/*.parquet');
CREATE VIEW repairs AS SELECT * FROM read_parquet('{root}repairs/*.parquet');
CREATE VIEW sketches AS SELECT * FROM read_parquet('{root}sketches/*.parquet');
CREATE VIEW frames AS SELECT * FROM read_parquet('{root}frames/*.parquet');
CREATE VIEW vocabulary AS SELECT * FROM read_parquet('{root}vocabulary/*.parquet');
CREATE VIEW rejects AS SELECT * FROM read_parquet('{root}rejects/*.parquet');
CREATE VIEW ledger AS SELECT * FROM read_parquet('{root}ledger/*.parquet');

-- One row a step; `number` counts from 0, as failures and ticks do.
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

-- One row for each tick done, with what it changed.
CREATE VIEW ticks AS
SELECT execution_id, program_id, environment_id, home, number, tick.*
FROM (
    SELECT execution_id, program_id, environment_id, home,
           unnest(ticks) AS tick, generate_subscripts(ticks, 1) AS number
    FROM executions
);

-- A step as people write it: [PutBack] <cup> (1) <table> (1)
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

-- The text of a program: its steps, one tick a line. (Inside, no column is called program_id, so that it can be asked
-- of a column of that name.)
CREATE MACRO program_text(which) AS (
    SELECT steps_text(its_steps)
    FROM (SELECT program_id AS its_id, steps AS its_steps FROM programs)
    WHERE its_id = which
);

-- Every edge after so many ticks of an execution (0: its start; NULL: its end).
CREATE MACRO graph_edges(which, after) AS TABLE
WITH case_of AS (
    SELECT e.home, e.ticks, v.added, v.removed, v.removed_nodes
    FROM executions e JOIN environments v ON v.environment_id = e.environment_id
    WHERE e.execution_id = which
),
tick AS (
    SELECT unnest(ticks) AS t, generate_subscripts(ticks, 1) AS number FROM case_of
),
event AS (
    SELECT source, relation, target, 0 AS moment, true AS holds
    FROM home_edges, case_of
    WHERE home_edges.home = case_of.home
      AND NOT list_contains(removed_nodes, source) AND NOT list_contains(removed_nodes, target)
    UNION ALL SELECT d.source, d.relation, d.target, 1, false FROM (SELECT unnest(removed) AS d FROM case_of)
    UNION ALL SELECT d.source, d.relation, d.target, 2, true FROM (SELECT unnest(added) AS d FROM case_of)
    UNION ALL SELECT d.source, d.relation, d.target, 2 + number, false
    FROM (SELECT unnest(t.removed) AS d, number FROM tick WHERE number <= coalesce(after, number))
    UNION ALL SELECT d.source, d.relation, d.target, 2 + number, true
    FROM (SELECT unnest(t.added) AS d, number FROM tick WHERE number <= coalesce(after, number))
)
SELECT source, relation, target FROM event
GROUP BY source, relation, target HAVING arg_max(holds, moment);

-- Every node after so many ticks of an execution (0: its start; NULL: its end), with the states it is in then.
CREATE MACRO graph_nodes(which, after) AS TABLE
WITH case_of AS (
    SELECT e.home, e.ticks, v.added_nodes, v.removed_nodes, v.set_states, v.cleared_states
    FROM executions e JOIN environments v ON v.environment_id = e.environment_id
    WHERE e.execution_id = which
),
node AS (
    SELECT id, class_name, category, properties, states
    FROM home_nodes, case_of
    WHERE home_nodes.home = case_of.home AND NOT list_contains(removed_nodes, id)
    UNION ALL
    SELECT n.id, n.class_name, n.category, n.properties, n.states FROM (SELECT unnest(added_nodes) AS n FROM case_of)
),
tick AS (
    SELECT unnest(ticks) AS t, generate_subscripts(ticks, 1) AS number FROM case_of
),
event AS (
    SELECT id AS node, unnest(states) AS state, 0 AS moment, true AS holds FROM node
    UNION ALL SELECT d.node, d.state, 1, false FROM (SELECT unnest(cleared_states) AS d FROM case_of)
    UNION ALL SELECT d.node, d.state, 2, true FROM (SELECT unnest(set_states) AS d FROM case_of)
    UNION ALL SELECT d.node, d.state, 2 + number, false
    FROM (SELECT unnest(t.cleared_states) AS d, number FROM tick WHERE number <= coalesce(after, number))
    UNION ALL SELECT d.node, d.state, 2 + number, true
    FROM (SELECT unnest(t.set_states) AS d, number FROM tick WHERE number <= coalesce(after, number))
),
holding AS (
    SELECT node, state FROM event GROUP BY node, state HAVING arg_max(holds, moment)
)
SELECT id, class_name, category, properties, coalesce(now, []) AS states
FROM node LEFT JOIN (SELECT node, list_sort(list(state)) AS now FROM holding GROUP BY node) ON node = id;

-- Which states things are in when an execution ends.
CREATE MACRO final_state(which) AS TABLE
SELECT id, class_name, unnest(states) AS state FROM graph_nodes(which, NULL);
