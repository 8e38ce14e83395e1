// An agent for `hearth play` in JavaScript: looks for the thing that it is to hold, in every room and cupboard.
const lines = require("readline").createInterface({ input: process.stdin });
const tried = new Set();
let wanted = "";

function choose({ legal, observation }) {
  const closed = observation.graph.nodes
    .filter((node) => node.states.includes("CLOSED") && !node.properties.includes("GRABBABLE"))
    .map((node) => `(1.${node.id})`);
  const rooms = observation.graph.nodes.filter((node) => node.category === "Rooms").map((node) => `(1.${node.id})`);
  const first = (action, about) =>
    legal.findIndex((text) => text.startsWith(`[${action}] `) && about(text) && !tried.has(text));
  const options = [
    first("Grab", (text) => text.includes(`<${wanted}>`)),
    first("Walk", (text) => text.includes(`<${wanted}>`)),
    first("Open", (text) => closed.some((node) => text.endsWith(node))),
    first("Walk", (text) => closed.some((node) => text.endsWith(node))),
    first("Walk", (text) => rooms.some((node) => text.endsWith(node))),
  ];
  const found = options.find((number) => number >= 0);
  tried.add(legal[found]);
  return found ?? null;
}

lines.on("line", (line) => {
  const message = JSON.parse(line);
  if (message.type === "begin") wanted = /HOLDS\(agent, (\w+)\)/.exec(message.goal)[1];
  if (message.type === "observe") console.log(JSON.stringify({ tick: message.tick, act: choose(message) }));
});
