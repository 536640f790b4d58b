// Tests inside the extension host, against the extension that was installed from its VSIX.
//
// Each exported suite is a list of [name, async function]. `run` writes one JSON line for each test into the file
// RUNGWISE_TEST_RESULTS, and at the end a line {"done": true}.

const fs = require('node:fs');

const SUITES = [
  './extension_tests', './diagnostics_tests', './language_tests', './translate_tests', './drawing_tests', './typing_tests', './pages_tests', './server_tests',
];
/** A part of the tests, while one works on it: a pattern for their names. */
const CHOSEN = new RegExp(process.env.RUNGWISE_TESTS_NAMED ?? '');
const TEST_TIMEOUT_MS = 120_000;

exports.run = async function run() {
  const results = process.env.RUNGWISE_TEST_RESULTS;
  const write = (line) => fs.appendFileSync(results, `${JSON.stringify(line)}\n`);
  try {
    for (const suite of SUITES) {
      for (const [name, body] of require(suite).filter(([name]) => CHOSEN.test(name))) {
        const start = Date.now();
        const error = await bounded(body).then(() => undefined, (reason) => reason);
        write({ name, durationMs: Date.now() - start, error: error && String(error.stack ?? error) });
      }
    }
  } catch (error) {
    write({ name: 'the tests can be loaded', durationMs: 0, error: String(error.stack ?? error) });
  }
  write({ done: true });
};

function bounded(body) {
  let timer;
  const timeout = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`no result within ${TEST_TIMEOUT_MS} ms`)), TEST_TIMEOUT_MS);
  });
  return Promise.race([Promise.resolve().then(body), timeout]).finally(() => clearTimeout(timer));
}
