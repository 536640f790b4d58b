--- :checkhealth rungwise
local client = require('rungwise.client')
local M = {}

function M.check()
  local health = vim.health
  health.start('rungwise')
  if vim.fn.has('nvim-0.11') == 1 then
    health.ok('Neovim has vim.lsp.enable')
  elseif vim.fn.has('nvim-0.10') == 1 then
    health.ok('Neovim 0.10: the server is started by vim.lsp.start')
  else
    health.error('Neovim 0.10 or later is needed')
  end

  local server = client.server()
  if vim.fn.executable(server) == 0 then
    health.error(('there is no program "%s"'):format(server), {
      'Build the server with `cargo build --release` and put `rungwise` on the PATH,',
      'or set the environment variable RUNGWISE_SERVER,',
      "or put `vim.g.rungwise = { server = '/path/to/rungwise' }` into your init.lua.",
    })
    return
  end
  local answer = vim.system({ server, '--version' }, { text = true, timeout = 10000 }):wait()
  local version = (answer.stdout or ''):match('^rungwise%s+(%S+)')
  if version then
    health.ok(('server %s, version %s'):format(vim.fn.exepath(server), version))
  else
    health.error(('"%s --version" did not answer as Rungwise does (exit code %s)'):format(server, answer.code))
  end
  health.info(('%d running clients'):format(#client.clients()))
end

return M
