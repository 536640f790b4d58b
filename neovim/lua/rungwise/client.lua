--- The language client: where the server is, what it is told, starting and restarting it.
local words = require('rungwise.words')
local M = {}

M.filetypes = { 'ladder', 'plc-il' }
M.root_markers = { 'rungwise.toml', '.git' }

--- The options that |g:rungwise| may have.
M.option_names = {
  'enable', 'server', 'extra_args', 'target', 'dialect', 'format', 'inlayHints', 'codeLens', 'diagnostics', 'language', 'mappings',
  'on_type',
}

--- Last `rungwise/status` of each program, by URI: { uri, target, dialect, steps, capacity, connection, mode }.
M.status = {}

--- What the user set in `vim.g.rungwise`, see |rungwise-options|.
function M.options()
  return type(vim.g.rungwise) == 'table' and vim.g.rungwise or {}
end

--- Places of the server in the order in which they are tried.
function M.server_candidates()
  local root = vim.fn.fnamemodify(debug.getinfo(1, 'S').source:sub(2), ':p:h:h:h:h')
  return vim.tbl_filter(function(path)
    return path ~= nil and path ~= ''
  end, {
    M.options().server or '',
    vim.env.RUNGWISE_SERVER or '',
    'rungwise',
    -- Beside the plugin, when it is used out of a clone in which the server was built.
    root .. '/target/release/rungwise',
  })
end

--- Program of the server. A path that the user gave is final: another server would hide that it is wrong.
function M.server()
  local given = M.options().server or vim.env.RUNGWISE_SERVER
  if given and given ~= '' then
    return vim.fn.expand(given)
  end
  for _, path in ipairs(M.server_candidates()) do
    if vim.fn.executable(path) == 1 then
      return path
    end
  end
  return 'rungwise'
end

--- The settings that the server gets, the same as in every other editor. What is null is left to rungwise.toml.
function M.settings()
  local options = M.options()
  local format = options.format or {}
  local hints = options.inlayHints or {}
  local lenses = options.codeLens or {}
  return {
    target = options.target or vim.NIL,
    dialect = options.dialect or vim.NIL,
    format = { style = format.style or vim.NIL, width = format.width or vim.NIL },
    language = words.language() or vim.NIL,
    inlayHints = { enabled = hints.enabled ~= false, comments = hints.comments ~= false },
    codeLens = {
      steps = lenses.steps ~= false,
      references = lenses.references ~= false,
      nextFree = lenses.nextFree ~= false,
      run = lenses.run ~= false,
    },
    diagnostics = { scope = (options.diagnostics or {}).scope or vim.NIL },
  }
end

local function on_status(_, status)
  if type(status) == 'table' and type(status.uri) == 'string' then
    M.status[status.uri] = status
    vim.cmd.redrawstatus({ bang = true })
  end
end

--- The configuration as |vim.lsp.config()| takes it.
function M.config()
  local settings = M.settings()
  return {
    name = 'rungwise',
    cmd = vim.list_extend({ M.server(), 'lsp' }, M.options().extra_args or {}),
    filetypes = M.filetypes,
    root_markers = M.root_markers,
    init_options = settings,
    settings = { rungwise = settings },
    capabilities = require('rungwise.translations').capabilities(),
    handlers = {
      ['rungwise/status'] = on_status,
      ['rungwise/monitor'] = function(...)
        require('rungwise.simulation').on_monitor(...)
      end,
      ['rungwise/plc'] = function(...)
        require('rungwise.plc').on_state(...)
      end,
      ['rungwise/alarm'] = function(...)
        require('rungwise.plc').on_alarm(...)
      end,
    },
  }
end

--- Configuration in force: that of the plugin, with what the user added by `vim.lsp.config('rungwise', …)`.
local function resolved()
  local configured = vim.lsp.config and vim.lsp.config.rungwise
  return vim.deepcopy(configured or M.config())
end

--- Whether a buffer is a program, a manifest, scenario tests, or Markdown with a program in a fence.
function M.serves(buffer)
  if vim.bo[buffer].filetype == 'toml' then
    local name = vim.fs.basename(vim.api.nvim_buf_get_name(buffer)) or ''
    return name == 'rungwise.toml' or vim.endswith(name, '.test.toml')
  elseif vim.bo[buffer].filetype ~= 'markdown' then
    return vim.list_contains(M.filetypes, vim.bo[buffer].filetype)
  end
  for _, line in ipairs(vim.api.nvim_buf_get_lines(buffer, 0, -1, false)) do
    local info = line:match('^%s*```+%s*([%w-]+)') or line:match('^%s*~~~+%s*([%w-]+)')
    if info and vim.list_contains({ 'ladder', 'lad', 'plc-ladder', 'il', 'plc-il' }, info:lower()) then
      return true
    end
  end
  return false
end

--- Starts the server for a buffer, or attaches the one that runs for its project.
function M.start(buffer)
  local config = resolved()
  -- The function that decides for a buffer has decided already.
  local given = type(config.root_dir) == 'string' and config.root_dir or nil
  config.root_dir = given or vim.fs.root(buffer, config.root_markers or M.root_markers)
  return vim.lsp.start(config, { bufnr = buffer })
end

--- Clients of a buffer; of all buffers without one.
function M.clients(buffer)
  return vim.lsp.get_clients({ name = 'rungwise', bufnr = buffer })
end

--- Makes the server start by itself. Answers nil and the reason when there is no server.
function M.enable()
  local server = M.server()
  if vim.fn.executable(server) == 0 then
    return nil, words.t('no language server at "%s"; see :checkhealth rungwise', server)
  end
  if vim.lsp.enable then
    vim.lsp.enable('rungwise')
    return true
  end
  -- Neovim 0.10 has no vim.lsp.enable.
  vim.api.nvim_create_autocmd('FileType', {
    group = vim.api.nvim_create_augroup('rungwise', { clear = true }),
    pattern = vim.list_extend({ 'toml' }, M.filetypes),
    callback = function(event)
      if M.serves(event.buf) then
        M.start(event.buf)
      end
    end,
  })
  return true
end

local function stop(client)
  -- Neovim 0.10 has functions where 0.11 has methods.
  if vim.fn.has('nvim-0.11') == 1 then
    client:stop(true)
  else
    client.stop(true)
  end
end

--- Ends every Rungwise server and starts new ones for the same buffers.
function M.restart()
  local buffers = {}
  local clients = M.clients()
  for _, client in ipairs(clients) do
    vim.list_extend(buffers, vim.lsp.get_buffers_by_client_id(client.id))
    stop(client)
  end
  vim.wait(3000, function()
    return #M.clients() == 0
  end, 20)
  if #clients == 0 then
    buffers = { vim.api.nvim_get_current_buf() }
  end
  for _, buffer in ipairs(buffers) do
    if M.serves(buffer) then
      M.start(buffer)
    end
  end
end

--- Sends a request and calls back with (error, result). Answers what cancels it.
function M.request(client, method, params, callback, buffer)
  local sent, id
  if vim.fn.has('nvim-0.11') == 1 then
    sent, id = client:request(method, params, callback, buffer)
  else
    sent, id = client.request(method, params, callback, buffer)
  end
  return sent and id or nil
end

--- Tells the server that nobody waits for the answer to a request any more.
function M.cancel(client, id)
  if id and vim.fn.has('nvim-0.11') == 1 then
    client:cancel_request(id)
  elseif id then
    client.cancel_request(id)
  end
end

--- Sends a request and waits for its result; nil if there is none in time or it is an error.
function M.request_sync(client, method, params, timeout_ms, buffer)
  local answer
  if vim.fn.has('nvim-0.11') == 1 then
    answer = client:request_sync(method, params, timeout_ms, buffer)
  else
    answer = client.request_sync(method, params, timeout_ms, buffer)
  end
  return answer and not answer.err and answer.result or nil
end

--- Column in bytes of a column in units of the protocol, both from 0; the end of the line for one beyond it.
function M.byte(text, character, encoding)
  if encoding == 'utf-8' then
    return math.min(character, #text)
  end
  local ok, byte
  if vim.fn.has('nvim-0.11') == 1 then
    ok, byte = pcall(vim.str_byteindex, text, encoding, character, false)
  else
    ok, byte = pcall(vim.str_byteindex, text, character, encoding == 'utf-16')
  end
  return ok and byte or #text
end

--- Column in units of the protocol of a column in bytes, both from 0.
function M.character(text, byte, encoding)
  if encoding == 'utf-8' then
    return byte
  elseif vim.fn.has('nvim-0.11') == 1 then
    return vim.str_utfindex(text, encoding, byte, false)
  end
  local utf32, utf16 = vim.str_utfindex(text, byte)
  return encoding == 'utf-16' and utf16 or utf32
end

--- Says something to the user.
function M.notify(message, level)
  vim.notify('Rungwise: ' .. message, level or vim.log.levels.INFO)
end

--- The client of a buffer that is to answer the user, who hears of it where there is none.
function M.expect(buffer)
  local running = M.clients(buffer)[1]
  if not running then
    M.notify(words.t('no language server for this buffer; see :checkhealth rungwise'), vim.log.levels.ERROR)
  end
  return running
end

--- Tells every server about changed settings.
function M.send_settings()
  local settings = { rungwise = M.settings() }
  for _, client in ipairs(M.clients()) do
    client.settings = settings
    if vim.fn.has('nvim-0.11') == 1 then
      client:notify('workspace/didChangeConfiguration', { settings = settings })
    else
      client.notify('workspace/didChangeConfiguration', { settings = settings })
    end
  end
end

return M
