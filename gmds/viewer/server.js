// Asking the server that this page comes from.
"use strict";

const TOKEN = new URLSearchParams(location.search).get("token") || "";

async function ask(path, given) {
  const headers = { "X-Gmds-Token": TOKEN, ...(given ? { "Content-Type": "application/json" } : {}) };
  let reply;
  try {
    reply = await fetch(path, { method: given ? "POST" : "GET", headers, body: given && JSON.stringify(given), cache: "no-store" });
  } catch {
    throw new Error("gmds view has ended: start it again, and save before you end it");
  }
  if (!reply.ok) throw new Error((await reply.json().catch(() => ({}))).error || `the server answered ${reply.status}`);
  return reply;
}

const askJson = async (path, given) => (await ask(path, given)).json();

// names of files travel as hexadecimal UTF-8, as headers hold ASCII only
async function fetchFile(given) {
  const reply = await ask("/file", given);
  const hex = reply.headers.get("X-Gmds-Name");
  const name = new TextDecoder().decode(Uint8Array.from(hex.match(/../g), (pair) => parseInt(pair, 16)));
  offer(await reply.blob(), name);
}
