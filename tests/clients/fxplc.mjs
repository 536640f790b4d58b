// The virtual PLC as a client sees it that was not written with it: node-fxplc, the plain commands over TCP.
//
// The binary is $RUNGWISE_SERVER. What the client writes is looked up by the person in front of the PLC, and what that
// person sets is read by the client. The client sends no ENQ, and refuses to write S, whose base it takes for missing.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { test } from 'node:test';
import { FXPLCClient, TransportTCP } from 'node-fxplc';

const server = process.env.RUNGWISE_SERVER ?? 'rungwise';

/** A virtual PLC, a person in front of it, and the client at its port. */
async function connected(context, ...options) {
  const plc = spawn(server, ['plc', '--listen', '127.0.0.1:0', ...options], { stdio: ['pipe', 'pipe', 'inherit'] });
  const lines = createInterface({ input: plc.stdout })[Symbol.asyncIterator]();
  const [, host, port] = /tcp:\/\/(.*):(\d+)$/.exec((await lines.next()).value);
  const transport = new TransportTCP({ host, port: Number(port), flushDelay: 0, timeout: 5000 });
  await transport.connect();
  const client = new FXPLCClient(transport, { timeoutMs: 5000 });
  // Node ends a program in which an error is heard by nobody.
  client.on('error', () => {});
  context.after(() => {
    client.close();
    plc.kill();
  });
  /** What the person reads of a device. */
  const shown = async (device) => {
    plc.stdin.write(`${device}\n`);
    return (await lines.next()).value.split(' = ')[1];
  };
  /** What the person sets. */
  const set = (device, value) => {
    plc.stdin.write(`${device}=${value}\n`);
    return shown(device);
  };
  return { client, shown, set };
}

const RELAYS = ['X0', 'X7', 'X10', 'X17', 'X77', 'Y0', 'Y7', 'Y10', 'Y77', 'M0', 'M8', 'M499', 'M1023', 'M1535'];
const WORDS = ['D0', 'D123', 'D999', 'T0', 'T7', 'T255', 'C0', 'C199'];

test('relays that the client switches are on, those around them are not', async (context) => {
  const { client, shown } = await connected(context, '--switch', 'stop');
  const off = await shown('M7');
  for (const relay of RELAYS) {
    assert.equal(await client.readBit(relay), false, relay);
    await client.writeBit(relay, true);
    assert.equal(await client.readBit(relay), true, relay);
    assert.notEqual(await shown(relay), off, relay);
    assert.equal(await shown('M7'), off);
    await client.writeBit(relay, false);
    assert.equal(await client.readBit(relay), false, relay);
    assert.equal(await shown(relay), off, relay);
  }
});

test('relays that somebody sets are read', async (context) => {
  const { client, set } = await connected(context, '--switch', 'stop');
  for (const relay of [...RELAYS, 'S0', 'S999']) {
    await set(relay, 1);
    assert.equal(await client.readBit(relay), true, relay);
    await set(relay, 0);
    assert.equal(await client.readBit(relay), false, relay);
  }
});

test('words go both ways, with their signs', async (context) => {
  const { client, shown, set } = await connected(context, '--switch', 'stop');
  for (const [number, word] of WORDS.entries()) {
    const value = number % 2 ? -1000 - number : 1000 + number;
    await client.writeInt(word, value);
    assert.equal(await shown(word), String(value), word);
    assert.equal(await client.readInt(word), value, word);
    await set(word, number);
    assert.equal(await client.readInt(word), number, word);
  }
  await client.batchWrite(['D10', 'D11', 'D12'], [1, -2, 32767]);
  assert.deepEqual(await client.batchRead(['D10', 'D11', 'D12', 'D13']), [1, -2, 32767, 0]);
  assert.equal(await shown('D12'), '32767');
});

test('a program runs under the client', async (context) => {
  const folder = await mkdtemp(join(tmpdir(), 'rungwise-client-'));
  context.after(() => rm(folder, { recursive: true }));
  const program = join(folder, 'motor.il');
  await writeFile(program, 'LD X0\nOR Y0\nANI X1\nOUT Y0\nOUT T0 K3\nLD X2\nOUT C0 K5\nEND\n');
  // Each request is a scan.
  const { client } = await connected(context, '--program', program, '--stepped', '--scan-time', '100ms');
  const holds = async (relay) => [await client.readBit(relay), await client.readBit(relay)][1];
  assert.equal(await holds('Y0'), false);
  await client.writeBit('X0', true);
  assert.equal(await holds('Y0'), true);
  await client.writeBit('X0', false);
  assert.equal(await holds('Y0'), true);
  for (let scan = 0; scan < 5; scan++) await client.readInt('T0');
  assert.equal(await client.readBit('T0'), true);
  assert.equal(await client.readInt('T0'), 3);
  for (let count = 0; count < 2; count++) {
    await client.writeBit('X2', true);
    await holds('X2');
    await client.writeBit('X2', false);
    await holds('X2');
  }
  assert.equal(await client.readInt('C0'), 2);
  await client.writeBit('X1', true);
  assert.equal(await holds('Y0'), false);
});

test('what the PLC does not have is refused', async (context) => {
  const { client } = await connected(context, '--switch', 'stop');
  await assert.rejects(client.readBytes(0xfff0, 4), { name: /NotSupported|Error/ });
  assert.equal(await client.readInt('D0'), 0, 'and it goes on');
});
