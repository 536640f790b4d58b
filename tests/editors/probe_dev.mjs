// dev probe
import { mkdtempSync, cpSync, writeFileSync } from 'node:fs';
import { execFileSync } from 'node:child_process';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
const T='/work/wt/editors/tests/editors';
const { CodeServer } = await import(T+'/vscode/code_server.mjs');
const { openBrowser } = await import(T+'/vscode/browser.mjs');
const { Workbench } = await import(T+'/vscode/workbench.mjs');
const home=mkdtempSync(join(tmpdir(),'rungwise-probe-'));
const server=new CodeServer('/work/main/.cache/editors',home);
const vsix=join(home,'r.vsix');
execFileSync(process.execPath,['/work/wt/editors/vscode-extension/scripts/package.mjs','--server','/tmp/edsrv/rungwise','--out',vsix],{stdio:['ignore','ignore','ignore']});
server.install(vsix);
const ws=join(home,'ws'); cpSync(T+'/fixtures',ws,{recursive:true});
await server.start(ws);
const browser=await openBrowser(home);
try{
 const wb=new Workbench(await browser.newPage(),'/tmp/edsrv');
 await wb.load(`http://${server.authority}/?folder=${ws}`);
 const mod=await import(process.argv[2]);
 await mod.default(wb,ws);
} catch(e){console.log('ERR',e.message);} finally { await browser.close(); server.stop(); console.log(home); }
process.exit(0);
