// A helper for a person who plays: `node helper.js PORT TOKEN`. It brings what can be taken nearby, one instruction a tick.
const socket = require("net").connect(Number(process.argv[2]), "127.0.0.1");
socket.write(`${JSON.stringify({ token: process.argv[3] })}\n`);
const lines = require("readline").createInterface({ input: socket });
let wanted = [];

function choose({ legal }) {
  const about = (text) => wanted.some((name) => text.includes(`<${name}>`));
  const first = (action) => legal.findIndex((text) => text.startsWith(`[${action}] `) && about(text));
  const options = [first("PutBack"), first("PutIn"), first("Grab"), first("Walktowards"), legal.indexOf("[Turnright]")];
  return options.find((number) => number >= 0) ?? null;
}

lines.on("line", (line) => {
  const message = JSON.parse(line);
  if (message.type === "begin") wanted = [...(message.goal ?? "").matchAll(/\((\w+),/g)].map((found) => found[1]);
  if (message.type === "observe") socket.write(`${JSON.stringify({ tick: message.tick, act: choose(message) })}\n`);
  if (message.type === "end") socket.end();
});
