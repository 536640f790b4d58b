--- :checkhealth rungwise
local client = require('rungwise.client')
local t = require('rungwise.words').t
local M = {}

local function check_neovim(health)
  local version = vim.version()
  local said = ('Neovim %d.%d.%d'):format(version.major, version.minor, version.patch)
  if vim.fn.has('nvim-0.11') == 1 then
    health.ok(t('%s has vim.lsp.enable', said))
  elseif vim.fn.has('nvim-0.10') == 1 then
    health.ok(t('%s: the server is started by vim.lsp.start', said))
  else
    health.error(t('%s: 0.10 or later is needed', said))
  end
end

--- Where the path of the server comes from, in words.
local function origin()
  if (client.options().server or '') ~= '' then
    return t('named by the option `server`')
  elseif (vim.env.RUNGWISE_SERVER or '') ~= '' then
    return t('named by RUNGWISE_SERVER')
  end
  return vim.fn.executable('rungwise') == 1 and t('found on the PATH') or t('found beside the plugin')
end

--- Answers whether there is a server that works.
local function check_server(health)
  local server = client.server()
  if vim.fn.executable(server) == 0 then
    health.error(t('there is no program "%s"', server), {
      t('Build the server with `cargo build --release` and put `rungwise` on the PATH,'),
      t('or set the environment variable RUNGWISE_SERVER,'),
      t("or put `vim.g.rungwise = { server = '/path/to/rungwise' }` into your init.lua."),
    })
    return false
  end
  local answer = vim.system({ server, '--version' }, { text = true, timeout = 10000 }):wait()
  local version = (answer.stdout or ''):match('^rungwise%s+(%S+)')
  if not version then
    health.error(t('"%s --version" did not answer as Rungwise does (exit code %s)', server, answer.code))
    return false
  end
  health.ok(t('server %s (%s), version %s', vim.fn.exepath(server), origin(), version))
  return true
end

local function check_clients(health)
  local clients = client.clients()
  if #clients == 0 then
    health.info(t('no server runs: it starts when a .lad or .il file is opened'))
  end
  for _, running in ipairs(clients) do
    local buffers = vim.tbl_map(function(buffer)
      local name = vim.fn.fnamemodify(vim.api.nvim_buf_get_name(buffer), ':~:.')
      return ('%s (%s)'):format(name ~= '' and name or '[No Name]', vim.bo[buffer].filetype)
    end, vim.lsp.get_buffers_by_client_id(running.id))
    local root = running.config.root_dir or t('no project: single files')
    health.ok(t('client %d, %s, positions in %s', running.id, root, running.offset_encoding))
    health.info(t('attached to %s', #buffers > 0 and table.concat(buffers, ', ') or t('no buffer')))
  end
end

local function check_options(health)
  health.info(client.options().on_type == false and t('typing: not formatted (`on_type = false`)')
    or t('typing: formatted by the plugin'))
  health.info(client.options().mappings == false and t('keys: none (`mappings = false`)')
    or t('keys: defaults, with <LocalLeader> %s', vim.inspect(vim.g.maplocalleader or '\\')))
  local hints = vim.lsp.inlay_hint and vim.lsp.inlay_hint.is_enabled()
  health.info(hints and t('inlay hints: on')
    or t('inlay hints: off; `:lua vim.lsp.inlay_hint.enable()` shows them'))
  for _, name in ipairs(vim.tbl_keys(client.options())) do
    if not vim.list_contains(client.option_names, name) then
      health.warn(t('g:rungwise has an option "%s" that does not exist', name), t('See :help rungwise-options'))
    end
  end
end

function M.check()
  local health = vim.health
  health.start(t('rungwise: Neovim'))
  check_neovim(health)
  health.start(t('rungwise: server'))
  if check_server(health) then
    check_clients(health)
  end
  health.start(t('rungwise: options'))
  check_options(health)
end

return M
